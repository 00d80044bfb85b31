#!/usr/bin/env python3
"""A connection to an MQTT broker.

    python3 bridge.py

See ../lib/helper.py for how it is asked.  `do` is one of

    connect      host port and what else there may be, see connection()
    publish      topic payload kind qos retain, and wait: answered when the
                 broker has it
    subscribe    filter kind qos
    unsubscribe  filter kind

A payload is text, bytes (a string of characters up to 255) or JSON, as its
kind says; one that comes in may be `auto`: JSON if it is an object or a list,
else text.  Events are

    message      topic payload kind qos retain keys, the filters it matches
    too_big      topic size keys
    up, down     the connection
    denied       filter

What is published while there is no connection is kept, so many messages at
the most, and so is what comes in a session that the broker has kept before
an agent subscribes to it.

The thread of paho runs its callbacks under locks that `publish` takes, too.
So these leave what happened to the thread that serves, by soon(), and only
that thread knows the state of the connection.  A message goes to Prolog in
the thread of paho, so that a broker that is too fast has to wait; which
filters it matches is asked of Filters, whose lock is never held around a
call of the client.
"""

import collections
import os
import socket
import ssl
import sys
import threading

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)),
                                '..', 'lib'))
from helper import LATER, BadRequest, Helper, Refusal, Unfit, \
    integer, text                                              # noqa: E402

try:
    import paho.mqtt.client as mqtt
    from paho.mqtt.matcher import MQTTMatcher
except ImportError as problem:
    mqtt, MISSING = None, problem

KINDS = ('auto', 'json', 'text', 'bytes')
BLANKS = '\ufeff \t\r\n'            # before JSON


def kind_of(request):
    kind = request.get('kind', 'auto')
    if kind not in KINDS:
        raise BadRequest('kind: %r is not known' % (kind,))
    return kind


def encoded(payload, kind):
    """The bytes of the text of a payload."""
    return payload.encode('latin-1' if kind == 'bytes' else 'utf-8')


def decoded(payload, kind):
    """The text of a payload, or its bytes, and whether it may be JSON."""
    try:
        if kind != 'bytes':
            said = payload.decode()
            return said, kind == 'json' or (
                kind == 'auto' and said.lstrip(BLANKS)[:1] in ('{', '['))
    except ValueError:
        pass
    return payload.decode('latin-1'), False


def new_client(client_id, clean):
    """A client of paho 1 or 2."""
    if hasattr(mqtt, 'CallbackAPIVersion'):
        return mqtt.Client(mqtt.CallbackAPIVersion.VERSION2, client_id,
                           clean_session=clean)
    return mqtt.Client(client_id, clean_session=clean)


def number(code):
    """Of a reason, in paho 1 or 2."""
    return code if isinstance(code, int) else code.value


def session_present(flags):
    if isinstance(flags, dict):
        return bool(flags.get('session present'))
    return bool(flags.session_present)


class Filters:
    """What agents have subscribed to, and what came before they did."""

    def __init__(self):
        self.lock = threading.Lock()
        self.kinds, self.qos = {}, {}   # filter: its kinds; its QoS
        self.matcher = MQTTMatcher()
        self.held = collections.deque()     # matches no filter yet
        self.most_held = self.largest_held = 0

    def names(self):
        """In the order in which they are to be asked for."""
        with self.lock:
            return list(self.qos)

    def first(self):
        """[filter, its QoS], or [] if there is none."""
        with self.lock:
            return list(next(iter(self.qos.items()), ()))

    def qos_of(self, wanted):
        """None if it is not wanted."""
        with self.lock:
            return self.qos.get(wanted)

    def add(self, wanted, kind, qos):
        with self.lock:
            self.kinds.setdefault(wanted, set()).add(kind)
            self.qos[wanted] = max(qos, self.qos.get(wanted, 0))
            self.matcher[wanted] = wanted

    def discard(self, wanted, kind):
        """Whether no kind of it is wanted any more."""
        with self.lock:
            kinds = self.kinds.get(wanted)
            if kinds is None:
                return False
            kinds.discard(kind)
            if not kinds:
                self.forget(wanted)
            return not kinds

    def drop(self, wanted):
        with self.lock:
            if wanted in self.kinds:
                self.forget(wanted)

    def forget(self, wanted):
        del self.kinds[wanted], self.qos[wanted], self.matcher[wanted]

    def put_last(self, wanted):
        with self.lock:
            if wanted in self.qos:
                self.qos[wanted] = self.qos.pop(wanted)

    def matching(self, topic, payload, qos, retain):
        """{kind: filters}; if there are none the message is held."""
        with self.lock:
            found = {}
            for wanted in self.matcher.iter_match(topic):
                for kind in self.kinds[wanted]:
                    found.setdefault(kind, []).append(wanted)
            if not found:
                self.hold(topic, payload, qos, retain)
            return found

    def hold(self, topic, payload, qos, retain):
        if self.most_held and len(payload) <= self.largest_held:
            self.held.append((topic, payload, qos, retain))
            if len(self.held) > self.most_held:
                self.held.popleft()

    def take_held(self, wanted):
        """The messages that were held and match."""
        with self.lock:
            taken = [one for one in self.held
                     if mqtt.topic_matches_sub(wanted, one[0])]
            if taken:
                self.held = collections.deque(
                    one for one in self.held
                    if not mqtt.topic_matches_sub(wanted, one[0]))
            return taken


class Broker(Helper):
    def __init__(self):
        super().__init__(longest_queue=10000, longest_line=1 << 26)
        self.client = None
        self.connected, self.connecting = False, None
        self.filters = Filters()
        self.todo = collections.deque() # filters to be subscribed to
        self.asked = None               # mid, filter: what the broker decides
        self.unlucky = {}               # filter: so often the broker hung up
        self.asking = {}                # filter: requests that wait for it
        self.waits = {}                 # mid: request, of publish
        self.kept = collections.deque()     # published with QoS 0, offline
        self.pending, self.largest = 1000, 1 << 22

    def run(self):
        threading.excepthook = self.thread_died
        super().run()

    def thread_died(self, what):
        """Without the thread of the connection nothing would arrive."""
        sys.__excepthook__(what.exc_type, what.exc_value, what.exc_traceback)
        os._exit(5)

    # Requests

    def do_connect(self, request, _deadline):
        self.pending = integer(request, 'pending', 1, 1000000)
        self.largest = integer(request, 'largest', 1, 1 << 25)
        clean = bool(request.get('clean', True))
        if not clean:
            self.filters.most_held = self.pending
            self.filters.largest_held = self.largest
        client = self.client = new_client(request.get('client', ''), clean)
        self.set_up(client, request)
        for wanted in request.get('filters', []):
            self.filters.add(wanted['filter'], wanted['kind'], wanted['qos'])
        address = (text(request, 'host'), integer(request, 'port', 1, 65535),
                   integer(request, 'keepalive', 1, 65535))
        if request.get('wait'):
            try:
                client.connect(*address)
            except ssl.SSLError as problem:
                raise Refusal('tls', str(problem)) from None
            except (OSError, ValueError) as problem:
                raise Refusal('unreachable', str(problem)) from None
            self.connecting = request
        else:
            client.connect_async(*address)
        client.loop_start()
        return LATER if request.get('wait') else {}

    def set_up(self, client, request):
        client.max_queued_messages_set(self.pending)
        client.max_inflight_messages_set(100)
        client.reconnect_delay_set(0.25, 30)
        if request.get('user') is not None:
            client.username_pw_set(request['user'], request.get('password'))
        will = request.get('will')
        if will:
            client.will_set(will['topic'],
                            encoded(will['payload'], will['kind']),
                            will['qos'], will['retain'])
        if request.get('tls'):
            self.set_up_tls(client, request)
        client.on_socket_open = self.at_once
        client.on_message = self.message
        client.on_connect = self.connack
        client.on_disconnect = lambda *_: self.soon(self.went)
        client.on_publish = lambda _client, _data, mid, *_: \
            self.soon(self.published, mid)
        client.on_subscribe = lambda _client, _data, mid, codes, *_: \
            self.soon(self.subscribed, mid, number(codes[0]))

    # Small packets wait for nothing: neither ours for more of them, nor those
    # of the broker, 40 ms each, for our acknowledgement of the one before.

    @staticmethod
    def at_once(_client, _data, sock):
        sock.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)

    def acknowledge(self):
        sock = self.client.socket()
        if sock is not None and hasattr(socket, 'TCP_QUICKACK'):
            try:
                sock.setsockopt(socket.IPPROTO_TCP, socket.TCP_QUICKACK, 1)
            except OSError:
                pass                    # it is being closed

    @staticmethod
    def set_up_tls(client, request):
        try:
            client.tls_set(ca_certs=request.get('ca'),
                           certfile=request.get('cert'),
                           keyfile=request.get('key'))
        except (OSError, ssl.SSLError, ValueError) as problem:
            raise Refusal('tls', str(problem)) from None
        if request.get('insecure'):
            client.tls_insecure_set(True)

    def do_publish(self, request, _deadline):
        topic, qos = text(request, 'topic'), integer(request, 'qos', 0, 2)
        retain, wait = bool(request.get('retain')), request.get('wait')
        try:
            payload = encoded(text(request, 'payload'), kind_of(request))
        except ValueError as problem:
            raise BadRequest('payload: %s' % problem) from None
        if len(payload) > self.largest:
            raise Refusal('too_big', '%d bytes' % len(payload))
        if qos == 0 and (self.kept or not self.connected):
            self.keep(topic, payload, retain, wait and request)
        else:
            self.publish(topic, payload, qos, retain, wait and request)
        return LATER if wait else {}

    def keep(self, topic, payload, retain, waiting):
        """Until there is a connection."""
        if len(self.kept) >= self.pending:
            raise Refusal('full', 'too much is kept for the broker')
        self.kept.append((topic, payload, 0, retain, waiting))

    def send_kept(self):
        """What was kept, when all that is wanted here can come."""
        while self.kept and self.connected and self.asked is None:
            try:
                if not self.publish(*self.kept.popleft()):
                    return
            except (BadRequest, Refusal) as problem:
                self.event('untold', message=str(problem))

    def publish(self, topic, payload, qos, retain, waiting):
        try:
            info = self.client.publish(topic, payload, qos, retain)
        except ValueError as problem:
            raise BadRequest(str(problem)) from None
        if info.rc == mqtt.MQTT_ERR_NO_CONN and qos == 0:
            self.kept.appendleft((topic, payload, qos, retain, waiting))
            return False                # until it comes back
        if info.rc == mqtt.MQTT_ERR_QUEUE_SIZE:
            raise Refusal('full', 'too much is kept for the broker')
        elif waiting:
            if qos == 0:
                self.reply(waiting, {})
            else:
                self.waits[info.mid] = waiting
        return True

    def do_subscribe(self, request, _deadline):
        wanted, kind = text(request, 'filter'), kind_of(request)
        self.filters.add(wanted, kind, integer(request, 'qos', 0, 2))
        for held in self.filters.take_held(wanted):
            self.tell(*held)
        if not self.connected:
            return {}
        self.asking.setdefault(wanted, []).append(request)
        self.todo.append(wanted)
        self.ask_next()
        return LATER

    def ask_next(self):
        """One filter at a time: the broker may hang up because of it."""
        while self.todo and self.asked is None and self.connected:
            wanted = self.todo.popleft()
            qos = self.filters.qos_of(wanted)
            if qos is not None:
                code, mid = self.client.subscribe(wanted, qos)
                if code == mqtt.MQTT_ERR_SUCCESS:
                    self.asked = mid, wanted
                else:                   # it will be asked for again
                    self.todo.clear()
            else:
                self.decided(wanted, {})

    def decided(self, wanted, answer):
        for request in self.asking.pop(wanted, []):
            self.reply(request, answer)

    def deny(self, wanted):
        self.filters.drop(wanted)
        self.unlucky.pop(wanted, None)
        self.event('denied', filter=wanted)
        self.decided(wanted, Refusal('denied', 'the broker refuses'))

    def do_unsubscribe(self, request, _deadline):
        wanted, kind = text(request, 'filter'), kind_of(request)
        if self.filters.discard(wanted, kind) and self.connected:
            self.client.unsubscribe(wanted)
        return {}

    def do_quit(self, _request, _deadline):
        self.farewell()
        return {}

    def abandoned(self):
        self.farewell()

    def farewell(self):
        if self.connected:
            self.connected = False
            self.client.disconnect()
            self.client.loop_stop()

    # What has happened to the connection; in the thread that serves

    def came(self, flags, code, asked):
        connecting, self.connecting = self.connecting, None
        if code:
            self.turned_away(connecting, code)
            return
        self.connected = True
        self.event('up', again=bool(self.filters.names()))
        if connecting:
            self.reply(connecting, {'session': session_present(flags)})
        self.asked = asked
        self.todo = collections.deque(
            wanted for wanted in self.filters.names()
            if asked is None or wanted != asked[1])
        if asked is not None and self.filters.qos_of(asked[1]) is None:
            self.client.unsubscribe(asked[1])
        self.ask_next()
        self.send_kept()

    def turned_away(self, connecting, code):
        if connecting:
            self.reply(connecting,
                       Refusal('refused', mqtt.connack_string(code)
                               if code < 128 else str(code)))
        else:
            self.event('refused', reason=code)

    def went(self):
        was, self.connected = self.connected, False
        if self.asked is not None:
            self.hung_up(self.asked[1])
        if was:
            self.event('down')

    def hung_up(self, wanted):
        """It may be because of that filter."""
        self.unlucky[wanted] = self.unlucky.get(wanted, 0) + 1
        if self.unlucky[wanted] > 1:
            self.deny(wanted)
        else:
            self.filters.put_last(wanted)

    def published(self, mid):
        waiting = self.waits.pop(mid, None)
        if waiting:
            self.reply(waiting, {})

    def subscribed(self, mid, code):
        if self.asked is None or self.asked[0] != mid:
            return
        wanted, self.asked = self.asked[1], None
        if code >= 128:
            self.deny(wanted)
        else:
            self.unlucky.pop(wanted, None)
            self.decided(wanted, {})
        self.ask_next()
        self.send_kept()

    # In the thread of the connection

    def connack(self, client, _data, flags, code, *_):
        """Subscribe before paho sends again what has QoS 1 or 2."""
        asked, first = None, self.filters.first()
        if number(code) == 0 and first:
            done, mid = client.subscribe(*first)
            if done == mqtt.MQTT_ERR_SUCCESS:
                asked = mid, first[0]
        self.soon(self.came, flags, number(code), asked)

    def message(self, _client, _data, message):
        self.acknowledge()
        try:
            topic = message.topic
        except UnicodeDecodeError:
            return
        self.tell(topic, message.payload, message.qos, bool(message.retain))

    def tell(self, topic, payload, qos, retain):
        found = self.filters.matching(topic, payload, qos, retain)
        for kind, filters in found.items():
            if len(payload) > self.largest:
                self.event('too_big', topic=topic, size=len(payload),
                           kind=kind, keys=filters)
            else:
                said, may_be_json = decoded(payload, kind)
                self.event('message', payload=said, json=may_be_json,
                           kind=kind, topic=topic, keys=filters, qos=qos,
                           retain=retain)


if __name__ == '__main__':
    (Broker() if mqtt else Unfit('no_paho', MISSING)).run()
