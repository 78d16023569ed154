"""A node of rclpy that does what it is told, by orders.py."""

import sys
import threading
import time

import rclpy
from codec import cls, fill, seen
from orders import obey, repeat, say
from rclpy.action import ActionServer, CancelResponse, GoalResponse
from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.executors import MultiThreadedExecutor
from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy
from rosidl_parser.definition import NamespacedType

# What is nested is looked at by its own fields.
ANY = NamespacedType(["", ""], "")


def profile(said):
    said = said or {}
    return QoSProfile(
        depth=said.get("depth", 10),
        reliability=ReliabilityPolicy.BEST_EFFORT if said.get("best_effort") else ReliabilityPolicy.RELIABLE,
        durability=DurabilityPolicy.TRANSIENT_LOCAL if said.get("transient_local") else DurabilityPolicy.VOLATILE)


class Peer(Node):
    def __init__(self, name, namespace):
        super().__init__(name, namespace=namespace)
        self.together = ReentrantCallbackGroup()
        self.kept = {}

    def publish(self, topic, type, value, qos=None, count=1, rate=100.0, size=None):
        message = fill(cls(type)(), value)
        if size is not None:
            message.data = bytes(size)
        if topic not in self.kept:
            self.kept[topic] = self.create_publisher(cls(type), topic, profile(qos))
        repeat(self.kept[topic].publish, message, count, rate)

    def stamp(self, topic, count, rate):
        """Publishes the time, and says how long that took."""
        publisher = self.create_publisher(cls("std_msgs/msg/Int64"), topic, 10)

        def send():
            # Time to be found.
            time.sleep(3.0)
            took = []
            for _ in range(count):
                began = time.time_ns()
                publisher.publish(fill(cls("std_msgs/msg/Int64")(), {"data": began}))
                took.append(time.time_ns() - began)
                time.sleep(1.0 / rate)
            say(stamped=topic, median=sorted(took)[count // 2])

        threading.Thread(target=send, daemon=True).start()

    def raw(self, topic, type, payload):
        """Bytes that need not be a message."""
        if topic not in self.kept:
            self.kept[topic] = self.create_publisher(cls(type), topic, 10)
        self.kept[topic].publish(bytes.fromhex(payload))

    def withdraw(self, topic):
        self.destroy_publisher(self.kept.pop(topic))

    def subscribe(self, topic, type, qos=None):
        heard = lambda message: say(heard=topic, value=seen(message, ANY))
        self.kept["<" + topic] = self.create_subscription(cls(type), topic, heard, profile(qos))

    def serve(self, service, type, reply, delay=0.0):
        def answer(request, response):
            say(asked=service, value=seen(request, ANY))
            time.sleep(delay)
            return fill(response, reply)

        kind = cls(type)
        self.kept[service] = self.create_service(kind, service, answer, callback_group=self.together)

    def act(self, action, type, how, feedback=(), result=None, steps=300, judging=0.0):
        kind = cls(type)

        def goal(request):
            say(goal=action, value=seen(request, ANY))
            time.sleep(judging)
            return GoalResponse.REJECT if how == "reject" else GoalResponse.ACCEPT

        def cancel(handle):
            say(cancel=action)
            return CancelResponse.ACCEPT

        def execute(handle):
            for fields in feedback:
                handle.publish_feedback(fill(kind.Feedback(), fields))
            for _ in range(steps if how == "run" else 0):
                if handle.is_cancel_requested:
                    handle.canceled()
                    return fill(kind.Result(), result or {})
                time.sleep(0.01)
            handle.abort() if how == "abort" else handle.succeed()
            return fill(kind.Result(), result or {})

        self.kept[action] = ActionServer(self, kind, action, execute, goal_callback=goal, cancel_callback=cancel,
                                         callback_group=self.together)

    def call(self, service, type, value):
        kind = cls(type)
        client = self.create_client(kind, service, callback_group=self.together)

        def ask():
            if not client.wait_for_service(timeout_sec=10.0):
                say(answer=service, error="no server")
                return
            future = client.call_async(fill(kind.Request(), value))
            future.add_done_callback(lambda done: say(answer=service, value=seen(done.result(), ANY)))

        threading.Thread(target=ask, daemon=True).start()

    def declare(self, name, value):
        self.declare_parameter(name, value)

    def read(self, name):
        say(parameter=name, value=self.get_parameter(name).value)

    def log(self, level, message):
        # rclpy wants one level for each place that logs.
        if level == "error":
            self.get_logger().error(message)
        else:
            self.get_logger().info(message)

    def clock(self, sec, nanosec):
        self.publish("/clock", "rosgraph_msgs/msg/Clock", {"clock": {"sec": sec, "nanosec": nanosec}})

    def graph(self, node, namespace="/"):
        topics = lambda pairs: sorted([name, *types] for name, types in pairs)
        try:
            say(graph=node, publishers=topics(self.get_publisher_names_and_types_by_node(node, namespace)),
                subscribers=topics(self.get_subscriber_names_and_types_by_node(node, namespace)),
                services=topics(self.get_service_names_and_types_by_node(node, namespace)),
                clients=topics(self.get_client_names_and_types_by_node(node, namespace)))
        except rclpy._rclpy_pybind11.NodeNameNonExistentError:
            say(graph=node, error="no such node")


def main(kind=Peer):
    rclpy.init()
    peer = kind(sys.argv[1] if len(sys.argv) > 1 else "peer", sys.argv[2] if len(sys.argv) > 2 else "/")
    executor = MultiThreadedExecutor(num_threads=4)
    executor.add_node(peer)
    threading.Thread(target=executor.spin, daemon=True).start()
    obey(peer)
    peer.destroy_node()
    rclpy.shutdown()


if __name__ == "__main__":
    main()
