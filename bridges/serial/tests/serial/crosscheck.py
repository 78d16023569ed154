"""Drives a Firmata board with an independent client, and prints what the board did as JSON.

python crosscheck.py TERMINAL"""

import json
import sys
import time

from pyfirmata2 import pyfirmata2
from pyfirmata2.boards import BOARDS

# The simulated board doesn't begin anew when its port is opened.
pyfirmata2.BOARD_SETUP_WAIT_TIME = 0.5

seen = {}
board = pyfirmata2.Board(sys.argv[1], BOARDS["arduino"], baudrate=57600, timeout=5)
board.samplingOn(20)
button, light = board.get_pin("d:7:i"), board.get_pin("a:0:i")
button.register_callback(lambda value: seen.__setitem__("button", int(value)))
light.register_callback(lambda value: seen.__setitem__("light", round(value * 1023)))
button.enable_reporting()
led, motor = board.get_pin("d:13:o"), board.get_pin("d:5:p")


def settled(led_value, motor_value):
    led.write(led_value)
    motor.write(motor_value / 255)
    before, end = None, time.monotonic() + 10
    while time.monotonic() < end:
        time.sleep(0.2)
        if len(seen) == 2 and seen == before:
            break
        before = dict(seen)
    return dict(before)


print(json.dumps([settled(1, 255), settled(0, 51)]))
board.exit()
