#!/usr/bin/env python3
"""Simulated robots with two wheels, as a node of ROS 2, and what they carry.

    python3 rovers.py '{"rovers": {"r1": [0, 0]}, "parcels": [[2, 1]]}'

Positions are metres.  Each rover NAME takes geometry_msgs/Twist on
/NAME/cmd_vel, of which x and the turn about z count, up to what it can, and
stops when it has heard nothing for half a second.  It tells where it is,
geometry_msgs/Pose, on /NAME/pose.  The services /NAME/load and /NAME/unload,
std_srvs/Trigger, take up a parcel that is near, and put it down.  Where the
parcels are is on /parcels, geometry_msgs/PoseArray.

It ends when its standard input does.
"""

import json
import math
import os
import sys
import threading
import time

import rclpy
from geometry_msgs.msg import Pose, PoseArray, Twist
from std_srvs.srv import Trigger

FASTEST, FASTEST_TURN = 2.0, 6.0        # metres, radians a second
REACH = 0.3                             # metres
STEP, SILENCE = 0.02, 0.5               # seconds


class Rover:
    def __init__(self, node, world, name, position):
        self.world, (self.x, self.y), self.turn = world, position, 0.0
        self.twist, self.heard, self.load = Twist(), 0.0, None
        node.create_subscription(Twist, '/%s/cmd_vel' % name, self.drive, 10)
        self.pose = node.create_publisher(Pose, '/%s/pose' % name, 10)
        node.create_service(Trigger, '/%s/load' % name, self.take)
        node.create_service(Trigger, '/%s/unload' % name, self.put)

    def drive(self, twist):
        self.twist, self.heard = twist, time.monotonic()

    def step(self):
        if time.monotonic() - self.heard > SILENCE:
            self.twist = Twist()
        speed = max(-FASTEST, min(FASTEST, self.twist.linear.x))
        turn = max(-FASTEST_TURN, min(FASTEST_TURN, self.twist.angular.z))
        self.turn += turn * STEP
        self.x += speed * math.cos(self.turn) * STEP
        self.y += speed * math.sin(self.turn) * STEP
        if self.load is not None:
            self.world.parcels[self.load] = [self.x, self.y]

    def tell(self):
        self.pose.publish(pose(self.x, self.y, self.turn))

    def take(self, _request, response):
        near = [number for number in range(len(self.world.parcels))
                if math.dist(self.world.parcels[number],
                             (self.x, self.y)) < REACH
                and not any(rover.load == number
                            for rover in self.world.rovers)]
        if self.load is not None or not near:
            response.message = 'nothing to take here'
        else:
            self.load = near[0]
            response.success, response.message = True, str(self.load)
        return response

    def put(self, _request, response):
        response.success = self.load is not None
        self.load = None
        return response


def pose(x, y, turn=0.0):
    message = Pose()
    message.position.x, message.position.y = x, y
    message.orientation.z = math.sin(turn / 2)
    message.orientation.w = math.cos(turn / 2)
    return message


class World:
    def __init__(self, scene):
        self.node = rclpy.create_node('rovers')
        self.parcels = [list(map(float, one)) for one in scene['parcels']]
        self.rovers = [Rover(self.node, self, name,
                             list(map(float, position)))
                       for name, position in scene['rovers'].items()]
        self.where = self.node.create_publisher(PoseArray, '/parcels', 10)
        self.node.create_timer(STEP, self.step)
        self.node.create_timer(0.05, self.tell)

    def step(self):
        for rover in self.rovers:
            rover.step()

    def tell(self):
        for rover in self.rovers:
            rover.tell()
        self.where.publish(PoseArray(poses=[pose(*parcel)
                                            for parcel in self.parcels]))


def ends():
    sys.stdin.read()
    os._exit(0)


if __name__ == '__main__':
    rclpy.init(args=[])
    world = World(json.loads(sys.argv[1]))
    threading.Thread(target=ends, daemon=True).start()
    print('ready', flush=True)
    rclpy.spin(world.node)
