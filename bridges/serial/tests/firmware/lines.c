// A robot that speaks in lines: says `ready`, then how it is 50 times a second.
//   M LEFT RIGHT   drives          S   halts
//   P N            pong N + 1      X   says what it can't do

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "uart.h"

static int write_byte(char byte, FILE *stream) {
    (void)stream;
    put(byte);
    return 0;
}

static FILE out = FDEV_SETUP_STREAM(write_byte, NULL, _FDEV_SETUP_WRITE);
static int left, right;
static unsigned count;

static void obey(char *line) {
    switch (line[0]) {
    case 'M': {
        char *rest;
        left = strtol(line + 1, &rest, 10);
        right = strtol(rest, NULL, 10);
        break;
    }
    case 'S':
        left = right = 0;
        printf("# halted\n");
        break;
    case 'P':
        printf("pong %d\n", atoi(line + 1) + 1);
        break;
    case 0:
        break;
    default:
        printf("error %s\n", line);
    }
}

static void hear(void) {
    static char line[64];
    static uint8_t length;
    for (int byte; (byte = get()) >= 0;) {
        if (byte == '\n') {
            line[length] = 0;
            obey(line);
            length = 0;
        } else if (length < sizeof line - 1) {
            line[length++] = byte;
        }
    }
}

int main(void) {
    begin();
    stdout = &out;
    // As long as a boot loader takes.
    while (now() < 100)
        nap();
    printf("ready lines 1\n");
    for (uint32_t due = now();;) {
        hear();
        if ((int32_t)(now() - due) >= 0) {
            due += 20;
            printf("light=%d left=%d right=%d n=%u\n", 100 + left / 2, left, right, count++);
        }
        nap();
    }
}
