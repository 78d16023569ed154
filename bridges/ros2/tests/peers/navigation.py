"""A robot that is driven as Nav2 does it, by the action NavigateToPose; a node that does what it is told besides.

It goes straight to the pose of a goal and tells how far that still is. It refuses goals that are not on its map, gets stuck
on the way to places that are blocked, and stands still once a goal is cancelled.
"""

import math
import time

from nav2_msgs.action import NavigateToPose
from node import Peer, main
from orders import say
from rclpy.action import ActionServer, CancelResponse, GoalResponse

PERIOD = 0.02
# The map: its frame, and how far it reaches from where the robot begins, m.
FRAME, REACH = "map", 10.0


def place(goal):
    return goal.pose.pose.position.x, goal.pose.pose.position.y


class Navigation(Peer):
    def __init__(self, name, namespace):
        super().__init__(name, namespace)
        self.at, self.velocity = (0.0, 0.0), 4.0
        self.blocked = []
        # The goal that it drives to; another takes its place.
        self.current = None
        self.kept["navigate"] = ActionServer(
            self, NavigateToPose, "/navigate_to_pose", self.drive, goal_callback=self.judge,
            cancel_callback=self.allow_cancel, callback_group=self.together)

    def block(self, x, y):
        self.blocked.append((x, y))

    def drive_at(self, velocity):
        self.velocity = velocity

    def judge(self, goal):
        is_on_map = goal.pose.header.frame_id == FRAME and math.hypot(*place(goal)) <= REACH
        say(goal=place(goal), accepted=is_on_map)
        return GoalResponse.ACCEPT if is_on_map else GoalResponse.REJECT

    def allow_cancel(self, handle):
        say(cancel=place(handle.request))
        return CancelResponse.ACCEPT

    def drive(self, handle):
        self.current = handle
        goal, began, result = place(handle.request), time.monotonic(), NavigateToPose.Result()
        # Half of the way is free.
        stuck = math.dist(self.at, goal) / 2 if goal in self.blocked else 0.0
        while (left := math.dist(self.at, goal)) > stuck:
            if handle.is_cancel_requested:
                handle.canceled()
                say(halted=self.at)
                return result
            if handle is not self.current:
                handle.abort()
                result.error_code, result.error_msg = NavigateToPose.Result.UNKNOWN, "another goal came"
                return result
            part = min(self.velocity * PERIOD / left, 1.0)
            self.at = tuple(here + part * (there - here) for here, there in zip(self.at, goal))
            handle.publish_feedback(self.progress(goal, time.monotonic() - began))
            time.sleep(PERIOD)
        if stuck:
            handle.abort()
            result.error_code, result.error_msg = NavigateToPose.Result.TIMEOUT, "something is in the way"
            say(stuck=self.at)
        else:
            handle.succeed()
            say(reached=self.at)
        return result

    def progress(self, goal, seconds):
        feedback = NavigateToPose.Feedback()
        feedback.current_pose.header.frame_id = FRAME
        feedback.current_pose.pose.position.x, feedback.current_pose.pose.position.y = self.at
        feedback.navigation_time.sec = int(seconds)
        feedback.navigation_time.nanosec = int(seconds % 1 * 1e9)
        feedback.distance_remaining = math.dist(self.at, goal)
        return feedback


main(Navigation)
