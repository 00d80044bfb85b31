#!/usr/bin/env python3
"""A node of ROS 2 that takes and gives the frames of rosbridge.

    python3 node.py [--node NAME] [--domain N] [--reach localhost|subnet]

See ../lib/helper.py for how it is asked; the only request is

    frame        frame: an object with `op`, as a rosbridge server takes it,
                 or {"op": "hello"}

which is answered when what the frame says is done, or begun.  The only event
is `frame`, with a frame as a server sends it.  Refused are

    no_type      type                   is not installed
    no_field     field                  the message has none of that name
    wrong_value  field type value
    ros          what else ROS says

What rosapi answers of topics and services is answered here.  When messages
come faster than they are taken some are dropped; then there is a frame

    dropped      topic count

Callbacks of rclpy run in the thread of the executor.  They pass messages on
to the outbox; what else they have to say they leave to the thread that
serves, by soon(), and only that thread knows what is advertised, subscribed
to and under way.
"""

import argparse
import collections
import os
import sys
import threading
import time
import uuid

sys.path[:0] = [os.path.dirname(os.path.abspath(__file__)),
                os.path.join(os.path.dirname(os.path.abspath(__file__)),
                             '..', 'lib')]
from helper import BadRequest, Helper, Refusal, Unfit, text  # noqa: E402

FINDING = 3.0                           # seconds until all nodes are known
MATCHING = 0.5                          # until one that is known hears us
MOST_HELD = 1000                        # messages until then, for each topic
MOST_CLIENTS = 100                      # of services and of actions
MOST_TOLD = 1000                        # messages that wait for Prolog
DEPTH = 1000                            # of the queues of ROS

arguments = argparse.ArgumentParser()
arguments.add_argument('--node', default='typhon')
arguments.add_argument('--domain')
arguments.add_argument('--reach', choices=('localhost', 'subnet'),
                       default='localhost')
options = arguments.parse_args()

# rclpy looks at these when it is imported.
if options.domain is not None:
    os.environ['ROS_DOMAIN_ID'] = options.domain
if options.reach == 'subnet':
    os.environ.pop('ROS_LOCALHOST_ONLY', None)
    os.environ['ROS_AUTOMATIC_DISCOVERY_RANGE'] = 'SUBNET'
elif os.environ.get('ROS_LOCALHOST_ONLY') != '1':
    os.environ['ROS_AUTOMATIC_DISCOVERY_RANGE'] = 'LOCALHOST'

try:
    import rclpy
    from rclpy.action import ActionClient
    from rclpy.event_handler import PublisherEventCallbacks, \
        SubscriptionEventCallbacks
    from rclpy.executors import ExternalShutdownException, \
        SingleThreadedExecutor
    from rclpy.qos import QoSDurabilityPolicy as Durability, QoSProfile, \
        QoSReliabilityPolicy as Reliability
    import messages
    MISSING = None
except ImportError as problem:
    MISSING = problem


def guarded(function, *arguments):
    """Of a callback that fails only that is said."""
    try:
        function(*arguments)
    except Exception as problem:
        print('%s: %s' % (type(problem).__name__, problem), file=sys.stderr)


class Outlet:
    """A publisher that keeps what it is given until it is heard.

    What is published at once would otherwise go out before the subscribers
    are known.
    """

    def __init__(self, node, cls, name, topic, born, soon):
        self.cls, self.name = cls, name
        self.held = []
        patience = born + FINDING - time.monotonic()
        if node.count_subscribers(topic) > 0:
            patience = max(patience, MATCHING)
        if patience <= 0:
            self.held = None
        self.publisher = node.create_publisher(
            cls, topic, QoSProfile(depth=DEPTH),
            event_callbacks=PublisherEventCallbacks(
                matched=lambda _status: soon(self.flush),
                use_default_callbacks=False))
        if patience > 0:
            timer = threading.Timer(patience, soon, (self.flush,))
            timer.daemon = True
            timer.start()

    def flush(self):
        held, self.held = self.held, None
        for message in held or ():
            self.publisher.publish(message)

    def publish(self, message):
        if self.held is None:
            self.publisher.publish(message)
        elif len(self.held) < MOST_HELD:
            self.held.append(message)
        else:
            raise Refusal('ros', 'more than %d messages wait for a '
                                 'subscriber' % MOST_HELD)


class Ear:
    """A subscription that takes what its publishers give.

    It waits for what is lost as long as all of them can repeat it, and has
    what was published before if all of them keep that.
    """

    def __init__(self, node, cls, topic, hear, soon):
        self.node, self.cls, self.topic, self.hear = node, cls, topic, hear
        self.soon = soon
        known = [info.qos_profile
                 for info in node.get_publishers_info_by_topic(topic)]
        self.subscription = None
        self.subscribe(
            any(qos.reliability == Reliability.BEST_EFFORT for qos in known),
            bool(known) and all(qos.durability == Durability.TRANSIENT_LOCAL
                                for qos in known))

    def subscribe(self, best_effort, kept):
        self.subscription = self.node.create_subscription(
            self.cls, self.topic, self.hear,
            QoSProfile(depth=DEPTH,
                       reliability=Reliability.BEST_EFFORT if best_effort
                       else Reliability.RELIABLE,
                       durability=Durability.TRANSIENT_LOCAL if kept
                       else Durability.VOLATILE),
            event_callbacks=SubscriptionEventCallbacks(
                incompatible_qos=None if best_effort and not kept
                else lambda _status: self.soon(self.incompatible),
                use_default_callbacks=False))

    def incompatible(self):
        if self.subscription is not None:
            old = self.subscription
            self.subscribe(True, False)
            self.node.destroy_subscription(old)

    def close(self):
        old, self.subscription = self.subscription, None
        self.node.destroy_subscription(old)


class Outbox:
    """Frames for Prolog.  The subscription does not wait until it reads."""

    def __init__(self, say):
        self.say, self.frames, self.messages = say, collections.deque(), 0
        self.dropped = collections.Counter()
        self.wake = threading.Condition()
        threading.Thread(target=self.run, daemon=True).start()

    def put(self, frame):
        with self.wake:
            self.append(frame)

    def put_message(self, frame):
        with self.wake:
            if self.messages < MOST_TOLD:
                self.messages += 1
                self.append(frame)
            else:
                self.dropped[frame['topic']] += 1

    def append(self, frame):
        self.frames.append(frame)
        self.wake.notify()

    def run(self):
        while True:
            with self.wake:
                self.wake.wait_for(lambda: self.frames)
                frame = self.frames.popleft()
                if frame['op'] == 'publish':
                    self.messages -= 1
                # What is missing was to come after all that is here.
                dropped = {} if self.frames else dict(self.dropped)
                if dropped:
                    self.dropped.clear()
            self.say(frame)
            for topic, count in dropped.items():
                self.say({'op': 'dropped', 'topic': topic, 'count': count})


class Clients:
    """Clients of services or actions, the last so many used."""

    def __init__(self, make, destroy):
        self.make, self.destroy = make, destroy
        self.kept = collections.OrderedDict()

    def client(self, name, type_name, cls):
        key = (name, type_name)
        if key not in self.kept:
            self.kept[key] = self.make(cls, name)
            if len(self.kept) > MOST_CLIENTS:
                self.destroy(self.kept.popitem(last=False)[1])
        self.kept.move_to_end(key)
        return self.kept[key]


class Node(Helper):
    """Serves frames, in the order in which they come."""

    def __init__(self, name):
        super().__init__()
        rclpy.init(args=[])
        self.node = rclpy.create_node(name)
        self.born = time.monotonic()
        self.outbox = Outbox(lambda frame: self.event('frame', frame=frame))
        self.executor = SingleThreadedExecutor()
        self.executor.add_node(self.node)
        self.outlets, self.subscriptions, self.services = {}, {}, {}
        self.calls = {}                 # id: how to respond
        self.waiting = {}               # client, future: deadline
        self.goals = {}                 # id: handle, or what is to be done
        self.clients = Clients(
            lambda cls, service: self.node.create_client(cls, service),
            self.node.destroy_client)
        self.actors = Clients(
            lambda cls, action: ActionClient(self.node, cls, action),
            lambda client: client.destroy())
        threading.Thread(target=self.spin, daemon=True).start()

    def spin(self):
        while True:
            try:
                self.executor.spin_once()
            except ExternalShutdownException:
                return
            except Exception as problem:        # of one callback
                print('%s: %s' % (type(problem).__name__, problem),
                      file=sys.stderr)

    def soon(self, function, /, *arguments):
        super().soon(guarded, function, *arguments)

    def do_frame(self, request, deadline):
        frame = request.get('frame')
        if not isinstance(frame, dict):
            raise BadRequest('frame: not an object')
        op = frame.get('op')
        method = getattr(self, 'op_' + op, None) \
            if isinstance(op, str) else None
        if method is None:
            raise BadRequest('op: %r is not known' % (op,))
        try:
            return method(frame, deadline) or {}
        except (Refusal, BadRequest):
            raise
        except Exception as problem:
            raise Refusal('ros', '%s: %s' % (type(problem).__name__,
                                             problem)) from None

    def do_quit(self, _request, _deadline):
        self.node.destroy_node()
        rclpy.try_shutdown()

    def frame(self, op, **fields):
        fields['op'] = op
        self.outbox.put(fields)

    def op_hello(self, _frame, _deadline):
        return {'node': self.node.get_fully_qualified_name(),
                'domain': os.environ.get('ROS_DOMAIN_ID', '0')}

    # Topics

    def op_advertise(self, frame, _deadline):
        topic, name = text(frame, 'topic'), text(frame, 'type')
        cls = messages.message_class(name)
        if topic not in self.outlets:
            self.outlets[topic] = Outlet(self.node, cls, name, topic,
                                         self.born, self.soon)

    def op_publish(self, frame, _deadline):
        topic = text(frame, 'topic')
        if topic not in self.outlets:
            raise Refusal('ros', '%s is not advertised' % topic)
        outlet = self.outlets[topic]
        message = messages.filled(outlet.cls, frame.get('msg'),
                                  self.node.get_clock())
        outlet.publish(message)

    def op_subscribe(self, frame, _deadline):
        topic = text(frame, 'topic')
        cls = messages.message_class(text(frame, 'type'))
        if topic not in self.subscriptions:
            self.subscriptions[topic] = Ear(
                self.node, cls, topic,
                lambda message: self.outbox.put_message(
                    {'op': 'publish', 'topic': topic,
                     'msg': messages.said(message)}), self.soon)

    def op_unsubscribe(self, frame, _deadline):
        subscription = self.subscriptions.pop(text(frame, 'topic'), None)
        if subscription is not None:
            subscription.close()

    # Calls

    def op_call_service(self, frame, deadline):
        number, service = text(frame, 'id'), text(frame, 'service')
        answers = {'/rosapi/topics': self.topics,
                   '/rosapi/services': self.service_names}
        if service in answers:
            self.respond(number, service, answers[service]())
            return
        name = text(frame, 'type')
        cls = messages.service_class(name)
        request = messages.filled(cls.Request, frame.get('args', {}))
        client = self.clients.client(service, name, cls)
        self.when_there(
            client.service_is_ready, client.wait_for_service, deadline,
            lambda: self.call(client, request, number, service, deadline),
            lambda: self.respond(number, service,
                                 'Service %s does not exist' % service,
                                 False))

    def when_there(self, is_ready, wait, deadline, then, otherwise):
        """Do not hold up others while a server is looked for."""
        if is_ready():
            then()
            return

        def look():
            left = min(FINDING, 0.9 * (deadline - time.monotonic()))
            found = wait(timeout_sec=max(0.0, left))
            self.soon(then if found else otherwise)
        threading.Thread(target=look, daemon=True).start()

    def call(self, client, request, number, service, deadline):
        now = time.monotonic()
        late = [one for one, until in self.waiting.items() if until < now]
        for old in late:
            del self.waiting[old]
            old[0].remove_pending_request(old[1])
        future = client.call_async(request)
        self.waiting[client, future] = deadline
        future.add_done_callback(
            lambda _: self.soon(self.answered, client, future, number,
                                service))

    def answered(self, client, future, number, service):
        self.waiting.pop((client, future), None)
        if future.exception() is not None:
            self.respond(number, service, str(future.exception()), False)
        elif future.result() is not None:
            self.respond(number, service, messages.said(future.result()))

    def respond(self, number, service, values, result=True):
        self.frame('service_response', id=number, service=service,
                   values=values, result=result)

    def topics(self):
        found = sorted(self.node.get_topic_names_and_types())
        return {'topics': [topic for topic, _ in found],
                'types': [types[0] for _, types in found]}

    def service_names(self):
        return {'services': sorted(
            service for service, _
            in self.node.get_service_names_and_types())}

    # What we offer

    def op_advertise_service(self, frame, _deadline):
        name = text(frame, 'service')
        cls = messages.service_class(text(frame, 'type'))
        if name not in self.services:
            # The request is passed on instead of a response, which comes
            # when there is one: nothing waits for it here.
            service = self.node.create_service(
                cls, name, lambda request, _response: request)
            respond = service.send_response

            def ask(request, header):
                self.soon(self.asked, name, cls, respond, header,
                          messages.said(request))
            service.send_response = ask
            self.services[name] = service

    def asked(self, name, cls, respond, header, request):
        if name in self.services:
            number = str(uuid.uuid4())
            self.calls[number] = (name, cls, respond, header)
            self.frame('call_service', id=number, service=name, args=request)

    def op_unadvertise_service(self, frame, _deadline):
        name = text(frame, 'service')
        service = self.services.pop(name, None)
        if service is not None:
            self.calls = {number: call for number, call
                          in self.calls.items() if call[0] != name}
            self.node.destroy_service(service)

    def op_service_response(self, frame, _deadline):
        """ROS cannot tell a caller that there will be no response."""
        number = str(frame.get('id'))
        if number in self.calls:
            _, cls, respond, header = self.calls[number]
            if frame.get('result'):
                respond(messages.filled(cls.Response,
                                        frame.get('values', {})), header)
            self.calls.pop(number, None)

    # Actions

    def op_send_action_goal(self, frame, deadline):
        number, action = text(frame, 'id'), text(frame, 'action')
        name = text(frame, 'action_type')
        cls = messages.action_class(name)
        goal = messages.filled(cls.Goal, frame.get('args', {}))
        client = self.actors.client(action, name, cls)
        self.goals[number] = None
        self.when_there(
            client.server_is_ready, client.wait_for_server, deadline,
            lambda: self.send_goal(client, goal, number, action),
            lambda: self.no_result(number, action,
                                   'No action server available'))

    def send_goal(self, client, goal, number, action):
        def heard(message):
            self.frame('action_feedback', id=number, action=action,
                       values=messages.said(message.feedback))

        client.send_goal_async(goal, feedback_callback=heard) \
            .add_done_callback(
                lambda future: self.soon(self.decided, future, number,
                                         action))

    def decided(self, future, number, action):
        handle = future.result()
        if handle is None or not handle.accepted:
            self.no_result(number, action, 'Action goal was rejected')
            return
        cancel, self.goals[number] = self.goals.get(number), handle
        if cancel:
            handle.cancel_goal_async()
        handle.get_result_async().add_done_callback(
            lambda future: self.soon(self.ended_goal, future, number, action))

    def ended_goal(self, future, number, action):
        self.goals.pop(number, None)
        result = future.result()
        self.frame('action_result', id=number, action=action,
                   values=messages.said(result.result),
                   status=result.status, result=True)

    def no_result(self, number, action, why):
        self.goals.pop(number, None)
        self.frame('action_result', id=number, action=action, values=why,
                   status=0, result=False)

    def op_cancel_action_goal(self, frame, _deadline):
        number = text(frame, 'id')
        handle = self.goals.get(number, True)
        if handle is None:
            self.goals[number] = True           # when it is accepted
        elif handle is not True:
            handle.cancel_goal_async()


if __name__ == '__main__':
    (Unfit('no_rclpy', MISSING) if MISSING else Node(options.node)).run()
