"""A robot with two driven wheels, a light sensor and a bumper, on a line that bends between two walls."""

import math

import rclpy
from geometry_msgs.msg import Twist
from rclpy.node import Node
from std_msgs.msg import Int32

PERIOD = 0.02
# Where the walls are, and the line's width.
LEFT, RIGHT, WIDTH = 0.0, 1.2, 0.06
RADIUS, AHEAD = 0.09, 0.08
# A command counts so long.
DEAD_MAN = 0.5


def line(x):
    return 0.08 * math.sin(4.0 * x)


class Robot(Node):
    def __init__(self):
        super().__init__("robot")
        self.x, self.y, self.heading = 0.6, line(0.6), 0.0
        self.command, self.age = Twist(), math.inf
        self.light = self.create_publisher(Int32, "light", 10)
        self.bumper = self.create_publisher(Int32, "bumper", 10)
        self.create_subscription(Twist, "cmd_vel", self.obey, 10)
        self.create_timer(PERIOD, self.move)

    def obey(self, command):
        self.command, self.age = command, 0.0

    def move(self):
        self.age += PERIOD
        if self.age < DEAD_MAN:
            self.heading += self.command.angular.z * PERIOD
            self.x += math.cos(self.heading) * self.command.linear.x * PERIOD
            self.y += math.sin(self.heading) * self.command.linear.x * PERIOD
        self.x = min(max(self.x, LEFT + RADIUS), RIGHT - RADIUS)
        is_touching = self.x in (LEFT + RADIUS, RIGHT - RADIUS)
        ahead = self.x + AHEAD * math.cos(self.heading), self.y + AHEAD * math.sin(self.heading)
        is_dark = abs(ahead[1] - line(ahead[0])) < WIDTH / 2
        self.light.publish(Int32(data=20 if is_dark else 230))
        self.bumper.publish(Int32(data=int(is_touching)))


rclpy.init()
rclpy.spin(Robot())
