"""A node of ROS 2 for the tests, that knows nothing of Typhon.

Echoes /in on /out; counts on /counted, best effort, and keeps `kept` on
/kept; has the service /flip, the action /fibonacci, which goes on until it is
cancelled if its order is 0, and refuses one below it, and the parameter
`speed`.  What it gets on /ask is the name of a service, std_srvs/SetBool,
which it calls, and how many seconds it waits; the answer is on /asked.
"""

import os
import sys
import threading
import time

import rclpy
from rclpy.action import ActionServer, CancelResponse, GoalResponse
from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.executors import MultiThreadedExecutor
from rclpy.qos import (QoSDurabilityPolicy, QoSProfile,
                       QoSReliabilityPolicy)
from std_msgs.msg import Int32, String
from std_srvs.srv import SetBool
from test_msgs.action import Fibonacci
from test_msgs.msg import Arrays, BasicTypes

rclpy.init()
node = rclpy.create_node('peer')
group = ReentrantCallbackGroup()
node.declare_parameter('speed', 0.5)
node.declare_parameter('names', ['a', 'b'])

out = node.create_publisher(String, '/out', 10)
node.create_subscription(
    String, '/in', lambda message: out.publish(message), 100)
types = node.create_publisher(BasicTypes, '/types_out', 10)
node.create_subscription(
    BasicTypes, '/types_in', lambda message: types.publish(message), 10)
arrays = node.create_publisher(Arrays, '/arrays_out', 10)
node.create_subscription(
    Arrays, '/arrays_in', lambda message: arrays.publish(message), 10)

kept = node.create_publisher(
    String, '/kept',
    QoSProfile(depth=1, durability=QoSDurabilityPolicy.TRANSIENT_LOCAL))
kept.publish(String(data='kept'))

counted = node.create_publisher(
    Int32, '/counted',
    QoSProfile(depth=1, reliability=QoSReliabilityPolicy.BEST_EFFORT))
count = 0


def tick():
    global count
    count += 1
    counted.publish(Int32(data=count))


node.create_timer(0.05, tick)


def flip(request, response):
    response.success = not request.data
    response.message = 'flipped'
    return response


node.create_service(SetBool, '/flip', flip)

asked = node.create_publisher(String, '/asked', 10)


def ask(message):
    name, seconds = message.data.split()
    client = node.create_client(SetBool, name, callback_group=group)
    if not client.wait_for_service(timeout_sec=5):
        asked.publish(String(data='no service'))
        return
    future = client.call_async(SetBool.Request(data=True))
    until = time.time() + float(seconds)
    while not future.done() and time.time() < until:
        time.sleep(0.01)
    asked.publish(String(data=future.result().message if future.done()
                         else 'no answer'))
    node.destroy_client(client)


node.create_subscription(String, '/ask', ask, 10, callback_group=group)


def fibonacci(goal):
    order, sequence = goal.request.order, [0, 1]
    while order == 0 or len(sequence) < order:
        if goal.is_cancel_requested:
            goal.canceled()
            return Fibonacci.Result(sequence=sequence)
        if len(sequence) < 40:
            sequence.append(sequence[-1] + sequence[-2])
        goal.publish_feedback(Fibonacci.Feedback(sequence=sequence))
        time.sleep(0.01)
    goal.succeed()
    return Fibonacci.Result(sequence=sequence)


ActionServer(node, Fibonacci, '/fibonacci', fibonacci, callback_group=group,
             goal_callback=lambda goal: GoalResponse.REJECT
             if goal.order < 0 else GoalResponse.ACCEPT,
             cancel_callback=lambda goal: CancelResponse.ACCEPT)

executor = MultiThreadedExecutor(4)
executor.add_node(node)
threading.Thread(target=executor.spin, daemon=True).start()
print('ready', flush=True)
sys.stdin.read()                        # until the test ends
os._exit(0)
