// As much of Firmata as the bridge needs, for the pins of an Uno: 0 to 13, and A0 to A5 as 14 to 19. Pins 5 and 6 can do
// PWM, 9 a servo.

#include <string.h>

#include "uart.h"

enum { INPUT = 0, OUTPUT = 1, ANALOG = 2, PWM = 3, SERVO = 4, PULLUP = 11 };
enum { PINS = 20, CHANNELS = 6, PORTS = 3 };

static uint8_t system[64];
static uint8_t reports_analog[CHANNELS], reports_digital[PORTS], told[PORTS], is_told[PORTS];
static uint16_t interval = 19;

// Where a pin is: port D, B or C, and its bit.
static volatile uint8_t *const levels[PORTS] = {&PIND, &PINB, &PINC};
static volatile uint8_t *const outputs[PORTS] = {&PORTD, &PORTB, &PORTC};
static volatile uint8_t *const directions[PORTS] = {&DDRD, &DDRB, &DDRC};

static uint8_t port_of(uint8_t pin) { return pin < 8 ? 0 : pin < 14 ? 1 : 2; }
static uint8_t bit_of(uint8_t pin) { return _BV(pin < 8 ? pin : pin < 14 ? pin - 8 : pin - 14); }

static void put_halves(uint16_t value) {
    put(value & 0x7f);
    put(value >> 7 & 0x7f);
}

static void tell_version(void) {
    put(0xf9);
    put(2);
    put(5);
}

static void tell_firmware(void) {
    put(0xf0);
    put(0x79);
    put(2);
    put(5);
    for (const char *name = "lrp test board"; *name; name++)
        put_halves(*name);
    put(0xf7);
}

static void tell_capabilities(void) {
    put(0xf0);
    put(0x6c);
    for (uint8_t pin = 0; pin < PINS; pin++) {
        if (pin > 1) {
            const uint8_t all[] = {INPUT, 1, PULLUP, 1, OUTPUT, 1};
            for (uint8_t i = 0; i < sizeof all; i++)
                put(all[i]);
            if (pin >= 14)
                put(ANALOG), put(10);
            if (pin == 5 || pin == 6)
                put(PWM), put(8);
            if (pin == 9)
                put(SERVO), put(14);
        }
        put(0x7f);
    }
    put(0xf7);
}

static void tell_channels(void) {
    put(0xf0);
    put(0x6a);
    for (uint8_t pin = 0; pin < PINS; pin++)
        put(pin >= 14 ? pin - 14 : 0x7f);
    put(0xf7);
}

// Firmata's port N is the pins from 8 * N on.
static uint8_t levels_of(uint8_t port) {
    uint8_t all = 0;
    for (uint8_t i = 0; i < 8; i++) {
        uint8_t pin = port * 8 + i;
        if (pin < PINS && *levels[port_of(pin)] & bit_of(pin))
            all |= _BV(i);
    }
    return all;
}

static void tell_digital(void) {
    for (uint8_t port = 0; port < PORTS; port++) {
        uint8_t all = levels_of(port);
        if (reports_digital[port] && (!is_told[port] || all != told[port])) {
            put(0x90 | port);
            put_halves(all);
            told[port] = all;
            is_told[port] = 1;
        }
    }
}

static void tell_analog(void) {
    for (uint8_t channel = 0; channel < CHANNELS; channel++) {
        if (!reports_analog[channel])
            continue;
        ADMUX = _BV(REFS0) | channel;
        ADCSRA = _BV(ADEN) | _BV(ADSC) | 7;
        while (ADCSRA & _BV(ADSC)) {
        }
        put(0xe0 | channel);
        put_halves(ADC);
    }
}

static void set_mode(uint8_t pin, uint8_t mode) {
    uint8_t port = port_of(pin), bit = bit_of(pin);
    if (pin >= PINS)
        return;
    if (mode == OUTPUT || mode == PWM || mode == SERVO)
        *directions[port] |= bit;
    else
        *directions[port] &= ~bit;
    if (mode == PULLUP)
        *outputs[port] |= bit;
    else
        *outputs[port] &= ~bit;
    if (mode == PWM && pin == 5)
        TCCR0A |= _BV(COM0B1) | _BV(WGM01) | _BV(WGM00), TCCR0B = _BV(CS01) | _BV(CS00);
    if (mode == PWM && pin == 6)
        TCCR0A |= _BV(COM0A1) | _BV(WGM01) | _BV(WGM00), TCCR0B = _BV(CS01) | _BV(CS00);
}

static void set_analog(uint8_t pin, uint16_t value) {
    if (pin == 5)
        OCR0B = value;
    if (pin == 6)
        OCR0A = value;
    if (pin == 9)
        OCR1A = value;
}

static void set_digital(uint8_t port, uint8_t all) {
    for (uint8_t i = 0; i < 8; i++) {
        uint8_t pin = port * 8 + i;
        if (pin >= PINS || !(*directions[port_of(pin)] & bit_of(pin)))
            continue;
        if (all & _BV(i))
            *outputs[port_of(pin)] |= bit_of(pin);
        else
            *outputs[port_of(pin)] &= ~bit_of(pin);
    }
}

static void obey_system(uint8_t length) {
    switch (system[0]) {
    case 0x79:
        tell_firmware();
        break;
    case 0x6b:
        tell_capabilities();
        break;
    case 0x69:
        tell_channels();
        break;
    case 0x6f:
        if (length > 2)
            set_analog(system[1], system[2] | (length > 3 ? system[3] << 7 : 0));
        break;
    case 0x7a:
        if (length > 2)
            interval = system[1] | system[2] << 7;
        break;
    }
}

// A command and its two bytes.
static void obey(uint8_t command, uint8_t first, uint8_t second) {
    uint8_t low = command & 0xf;
    switch (command < 0xf0 ? command & 0xf0 : command) {
    case 0xf4:
        set_mode(first, second);
        break;
    case 0x90:
        set_digital(low, first | second << 7);
        break;
    case 0xe0:
        set_analog(low, first | second << 7);
        break;
    case 0xc0:
        if (low < CHANNELS)
            reports_analog[low] = first;
        break;
    case 0xd0:
        if (low < PORTS)
            reports_digital[low] = first, is_told[low] = 0;
        break;
    }
}

static uint8_t size_of(uint8_t command) {
    switch (command < 0xf0 ? command & 0xf0 : command) {
    case 0xc0:
    case 0xd0:
        return 1;
    case 0x90:
    case 0xe0:
    case 0xf4:
        return 2;
    default:
        return 0;
    }
}

static void hear(void) {
    static uint8_t command, data[2], count, length;
    for (int byte; (byte = get()) >= 0;) {
        if (byte == 0xf7 && command == 0xf0) {
            obey_system(length);
            command = 0;
        } else if (byte >= 0x80) {
            command = byte;
            count = length = 0;
            if (byte == 0xf9)
                tell_version();
        } else if (command == 0xf0) {
            if (length < sizeof system)
                system[length++] = byte;
        } else if (count < size_of(command)) {
            data[count++] = byte;
            if (count == size_of(command)) {
                obey(command, data[0], count > 1 ? data[1] : 0);
                command = 0;
            }
        }
    }
}

int main(void) {
    begin();
    while (now() < 100)
        nap();
    // Unasked, as boards do when they begin.
    tell_version();
    tell_firmware();
    for (uint32_t due = now();;) {
        hear();
        tell_digital();
        if ((int32_t)(now() - due) >= 0) {
            due = now() + interval;
            tell_analog();
        }
        nap();
    }
}
