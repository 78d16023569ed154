// A simulated board: an ATmega328 that runs a firmware, its UART a pseudo terminal. Three wires lead back into it: pin 13
// to pin 7, pin 12 to pin 4, and pin 5's PWM, smoothed, to A0. A1 is at 3 V.
//   board FIRMWARE SECONDS    says the terminal's name, runs for so long; SIGUSR1 is its reset button, SIGUSR2 turns the
//                             level at pin 8 over, which is high at first

#include <libelf.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/prctl.h>
#include <unistd.h>

#include <simavr/avr_adc.h>
#include <simavr/avr_ioport.h>
#include <simavr/avr_timer.h>
#include <simavr/avr_uart.h>
#include <simavr/parts/uart_pty.h>
#include <simavr/sim_avr.h>
#include <simavr/sim_elf.h>

static uart_pty_t uart;
static volatile sig_atomic_t reset, bump;
// When the last byte was sent.
static avr_cycle_count_t sent;

static void press_reset(int signal) {
    (void)signal;
    reset = 1;
}

static void press_bumper(int signal) {
    (void)signal;
    bump = 1;
}

static avr_irq_t *pin(avr_t *avr, char port, int bit) {
    return avr_io_getirq(avr, AVR_IOCTL_IOPORT_GETIRQ(port), bit);
}

// A duty of 255 is 5 V.
static void smooth(avr_irq_t *irq, uint32_t duty, void *adc) {
    (void)irq;
    avr_raise_irq(adc, duty * 5000 / 255);
}

static void note_sent(avr_irq_t *irq, uint32_t byte, void *avr) {
    (void)irq;
    (void)byte;
    sent = ((avr_t *)avr)->cycle;
}

int main(int count, char **arguments) {
    elf_firmware_t firmware;
    memset(&firmware, 0, sizeof firmware);
    if (count != 3 || elf_read_firmware(arguments[1], &firmware)) {
        fprintf(stderr, "board FIRMWARE SECONDS\n");
        return 2;
    }
    // Never longer than whoever started it.
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    alarm(atoi(arguments[2]));
    signal(SIGUSR1, press_reset);
    signal(SIGUSR2, press_bumper);

    avr_t *avr = avr_make_mcu_by_name("atmega328p");
    avr_init(avr);
    avr->log = LOG_ERROR;
    avr->frequency = 16000000;
    avr->vcc = avr->avcc = avr->aref = 5000;
    avr_load_firmware(avr, &firmware);

    avr_connect_irq(pin(avr, 'B', 5), pin(avr, 'D', 7));
    avr_connect_irq(pin(avr, 'B', 4), pin(avr, 'D', 4));
    avr_irq_t *duty = avr_io_getirq(avr, AVR_IOCTL_TIMER_GETIRQ('0'), TIMER_IRQ_OUT_PWM1);
    avr_irq_t *adc = avr_io_getirq(avr, AVR_IOCTL_ADC_GETIRQ, ADC_IRQ_ADC0);
    avr_irq_register_notify(duty, smooth, adc);
    avr_raise_irq(adc + 1, 3000);
    avr_irq_t *bumper = pin(avr, 'B', 0);
    int level = 1;
    avr_raise_irq(bumper, level);

    avr_irq_t *output = avr_io_getirq(avr, AVR_IOCTL_UART_GETIRQ('0'), UART_IRQ_OUTPUT);
    avr_irq_register_notify(output, note_sent, avr);

    uart_pty_init(avr, &uart);
    uart_pty_connect(&uart, '0');
    printf("terminal %s\n", uart.pty.slavename);
    fflush(stdout);
    for (int state = cpu_Running; state != cpu_Done && state != cpu_Crashed; state = avr_run(avr)) {
        if (bump) {
            bump = 0;
            level = !level;
            avr_raise_irq(bumper, level);
        }
        // A reset amid a byte leaves the simulated UART stuck.
        if (reset && avr->cycle - sent > 16000) {
            reset = 0;
            avr_reset(avr);
            // It forgets what is outside.
            avr_raise_irq(bumper, !level);
            avr_raise_irq(bumper, level);
        }
    }
    return 1;
}
