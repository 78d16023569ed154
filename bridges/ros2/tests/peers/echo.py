"""Publishes what it hears, as fast as rclpy can: pairs of topics as arguments, from and to, of type std_msgs/msg/Int64."""

import sys

import rclpy
from rclpy.executors import SingleThreadedExecutor
from std_msgs.msg import Int64

rclpy.init()
node = rclpy.create_node("echo")
for source, target in zip(sys.argv[1::2], sys.argv[2::2]):
    node.create_subscription(Int64, source, node.create_publisher(Int64, target, 10).publish, 10)
# Several threads would wait for each other.
executor = SingleThreadedExecutor()
executor.add_node(node)
print('{"up": true}', flush=True)
executor.spin()
