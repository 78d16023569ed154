// As much of Arduino as the sketch in docs/serial.md uses.

#include <math.h>
#include <stdlib.h>

#include "uart.h"

typedef uint8_t byte;

enum { LOW = 0, HIGH = 1, OUTPUT = 1, INPUT_PULLUP = 2, A1 = 15 };

#define constrain(value, least, most) ((value) < (least) ? (least) : (value) > (most) ? (most) : (value))

static volatile uint8_t &output(int pin) { return pin < 8 ? PORTD : PORTB; }
static volatile uint8_t &direction(int pin) { return pin < 8 ? DDRD : DDRB; }
static uint8_t bit(int pin) { return _BV(pin & 7); }

static unsigned long millis() { return now(); }

static void digitalWrite(int pin, bool level) { output(pin) = level ? output(pin) | bit(pin) : output(pin) & ~bit(pin); }
static bool digitalRead(int pin) { return (pin < 8 ? PIND : PINB) & bit(pin); }

static void pinMode(int pin, int mode) {
    direction(pin) = mode == OUTPUT ? direction(pin) | bit(pin) : direction(pin) & ~bit(pin);
    digitalWrite(pin, mode == INPUT_PULLUP);
}

static void analogWrite(int pin, int duty) {
    direction(pin) |= bit(pin);
    TCCR0A = _BV(COM0A1) | _BV(COM0B1) | _BV(WGM01) | _BV(WGM00);
    TCCR0B = _BV(CS01) | _BV(CS00);
    (pin == 5 ? OCR0B : OCR0A) = duty;
}

static int analogRead(int pin) {
    ADMUX = _BV(REFS0) | (pin - 14);
    ADCSRA = _BV(ADEN) | _BV(ADSC) | 7;
    while (ADCSRA & _BV(ADSC)) {
    }
    return ADC;
}

static struct {
    void begin(long) {}
    bool available() { return ring_in != ring_out; }
    int read() { return get(); }
    void print(const char *text) {
        while (*text)
            put(*text++);
    }
    void print(long number) {
        char text[12];
        print(ltoa(number, text, 10));
    }
    template <typename T> void println(T value) {
        print(value);
        print("\r\n");
    }
} Serial;

void setup();
void loop();

int main() {
    begin();
    setup();
    for (;;) {
        loop();
        nap();
    }
}
