// What both firmwares stand on: a UART that is heard in the background, and milliseconds that go by while the
// processor sleeps.

#include <avr/interrupt.h>
#include <avr/io.h>
#include <avr/sleep.h>
#include <stdint.h>

static volatile uint8_t ring[128];
static volatile uint8_t ring_in, ring_out;
static volatile uint32_t ticks;

ISR(USART_RX_vect) {
    uint8_t byte = UDR0, next = (ring_in + 1) & 127;
    if (next != ring_out) {
        ring[ring_in] = byte;
        ring_in = next;
    }
}

ISR(TIMER2_COMPA_vect) {
    ticks++;
}

// 115200 baud and 1 ms, at 16 MHz.
static void begin(void) {
    UCSR0A = _BV(U2X0);
    UBRR0 = 16;
    UCSR0C = _BV(UCSZ01) | _BV(UCSZ00);
    UCSR0B = _BV(RXEN0) | _BV(TXEN0) | _BV(RXCIE0);
    TCCR2A = _BV(WGM21);
    TCCR2B = _BV(CS22);
    OCR2A = 249;
    TIMSK2 = _BV(OCIE2A);
    set_sleep_mode(SLEEP_MODE_IDLE);
    sei();
}

static void put(uint8_t byte) {
    while (!(UCSR0A & _BV(UDRE0))) {
    }
    UDR0 = byte;
}

// The next byte, or -1.
static int get(void) {
    if (ring_in == ring_out)
        return -1;
    uint8_t byte = ring[ring_out];
    ring_out = (ring_out + 1) & 127;
    return byte;
}

static uint32_t now(void) {
    cli();
    uint32_t ms = ticks;
    sei();
    return ms;
}

// Until a byte comes or a millisecond has gone by.
static void nap(void) {
    sleep_mode();
}
