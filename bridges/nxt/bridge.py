#!/usr/bin/env python3
"""The bridge between Prolog and one NXT.

    python3 bridge.py PORT [--baudrate N]

PORT is a device, or any URL of pyserial, as socket://host:port.  Requests
come on the standard input, replies go to the standard output: one JSON
object per line, UTF-8, no line longer than 65536 bytes.

    {"id": 7, "do": "telegram", "command": "GETBATTERYLEVEL", "timeout": 3}
    {"id": 7, "ok": {"millivolts": 7423}}
    {"id": 8, "error": "timeout", "message": "the brick is silent"}

`do` is one of

    open                            open the port, ask for the firmware
    telegram command args reply     see telegram.py; reply may be missing
    sensor   port type mode         set up if it is not, read when valid
    i2c      port data rx           a transaction
    display  column row text        write on the display
    clear                           the display
    close                           the port; the next request opens it
    quit                            close, and end

Data are strings of hexadecimal digits.  Requests are served one after the
other; the timeout, in seconds, counts from when the line was read.  When
the standard input ends without `quit`, nobody drives the robot any more:
the motors are let go, and the process ends.
"""

import argparse
import json
import os
import queue
import signal
import sys
import threading
import time

try:
    import serial
    from brick_calls import BrickCalls
    from line import Line, LineError
except ImportError as problem:
    serial, MISSING = None, problem
import display
import telegram

LONGEST_LINE = 65536                    # bytes
LONGEST_QUEUE = 1000                    # requests
LONGEST_TIMEOUT = 3600.0                # seconds
FAREWELL = 2.0                          # seconds, to let the motors go
NO_PYSERIAL = 3                         # exit status


class BadRequest(Exception):
    """A line that is no request."""


class Output:
    """Lines to Prolog, from any thread."""

    def __init__(self, stream):
        self.stream, self.lock = stream, threading.Lock()

    def say(self, message):
        line = json.dumps(message, default=bytes.hex) + '\n'
        with self.lock:
            try:
                self.stream.write(line.encode())
                self.stream.flush()
            except OSError:
                pass        # nobody reads; standard input ends, too


# Requests

def integer(request, field, least, most):
    value = request.get(field)
    if isinstance(value, bool) or not isinstance(value, int) \
            or not least <= value <= most:
        raise BadRequest('%s: not an integer from %d to %d'
                         % (field, least, most))
    return value


def hexadecimal(value, field):
    try:
        return bytes.fromhex(value)
    except (TypeError, ValueError):
        raise BadRequest('%s: not hexadecimal digits' % field) from None


def arguments(name, values):
    """The values of a command, its data as bytes."""
    if not isinstance(values, dict):
        raise BadRequest('args: not an object')
    data = {field for field, kind in telegram.command_of(name).request
            if kind[0] in 'xm*'}
    return {field: hexadecimal(value, field) if field in data else value
            for field, value in values.items()}


def parse(line):
    """The request of a line, with the time by which it must be done."""
    try:
        request = json.loads(line.decode())
    except ValueError as problem:
        raise BadRequest('not JSON: %s' % problem) from None
    if not isinstance(request, dict):
        raise BadRequest('not an object')
    return request


def deadline_of(request):
    timeout = request.get('timeout', 3.0)
    if isinstance(timeout, bool) or not isinstance(timeout, (int, float)) \
            or not 0 < timeout <= LONGEST_TIMEOUT:
        raise BadRequest('timeout: not a number of seconds up to %d'
                         % LONGEST_TIMEOUT)
    return time.monotonic() + timeout


class Bridge:
    """Serves requests with one brick."""

    def __init__(self, line, output):
        self.line, self.output = line, output
        self.calls = BrickCalls(line)
        self.requests = queue.Queue(LONGEST_QUEUE)
        self.quitting = False

    # In a thread of its own: standard input

    def listen(self, stream):
        while True:
            line = stream.readline(LONGEST_LINE + 1)
            if not line.endswith(b'\n'):
                if len(line) <= LONGEST_LINE:
                    break               # the end
                self.refuse(None, 'a line of more than %d bytes'
                            % LONGEST_LINE)
                while line and not line.endswith(b'\n'):
                    line = stream.readline(LONGEST_LINE)
            elif line.strip():
                self.accept(line)
        self.abandoned()

    def accept(self, line):
        number = None
        try:
            request = parse(line)
            number = integer(request, 'id', 0, 2 ** 62)
            deadline = deadline_of(request)
            if request.get('do') == 'quit':
                self.quitting = True
                self.drop_requests()
            self.requests.put_nowait((number, request, deadline))
        except BadRequest as problem:
            self.refuse(number, str(problem))
        except queue.Full:
            self.refuse(number, 'more than %d requests wait' % LONGEST_QUEUE)

    def refuse(self, number, why):
        self.output.say({'id': number, 'error': 'bad_request',
                         'message': why})

    def drop_requests(self):
        """Nobody wants what is still to be done."""
        self.line.cancel()
        try:
            while True:
                self.requests.get_nowait()
        except queue.Empty:
            pass

    def abandoned(self):
        if not self.quitting:               # Prolog is gone
            self.drop_requests()
            self.requests.put(None)
        time.sleep(2 * FAREWELL)            # a port may block for ever
        os._exit(1)

    # In the main thread: the brick

    def serve(self):
        while True:
            job = self.requests.get()
            if job is None:
                self.farewell()
                return
            number, request, deadline = job
            self.output.say(dict(self.answer(request, deadline), id=number))
            if request.get('do') == 'quit':
                return

    def answer(self, request, deadline):
        try:
            if time.monotonic() >= deadline:
                raise LineError('timeout', 'not done: others took too long')
            return {'ok': self.do(request, deadline)}
        except LineError as problem:
            return dict(problem.more, error=problem.kind,
                        message=str(problem))
        except (BadRequest, telegram.BadTelegram) as problem:
            return {'error': 'bad_request', 'message': str(problem)}

    def do(self, request, deadline):
        what = request.get('do')
        if what == 'telegram':
            name = request.get('command')
            values = arguments(name, request.get('args', {}))
            return self.calls.telegram(name, values, request.get('reply'),
                                       deadline)
        if what == 'sensor':
            return self.calls.sensor(integer(request, 'port', 0, 3),
                                     integer(request, 'type', 0, 0x12),
                                     integer(request, 'mode', 0, 0xFF),
                                     deadline)
        if what == 'i2c':
            data = hexadecimal(request.get('data'), 'data')
            if not 1 <= len(data) <= 16:
                raise BadRequest('data: not 1 to 16 bytes')
            rx = integer(request, 'rx', 0, 15)
            port = integer(request, 'port', 0, 3)
            return {'data': self.calls.i2c(port, data, rx, deadline)}
        if what == 'display':
            text = request.get('text')
            if not isinstance(text, str):
                raise BadRequest('text: not a string')
            return self.calls.show(
                display.write(integer(request, 'column', 0, 15),
                              integer(request, 'row', 0, 7), text), deadline)
        if what == 'clear':
            return self.calls.show(display.clear(), deadline)
        if what == 'open':
            return self.calls.open(deadline)
        if what in ('close', 'quit'):
            self.line.close()
            return {}
        raise BadRequest('do: %r is not known' % (what,))

    def farewell(self):
        """Let all motors go, if the line is open."""
        self.line.cancelled = False
        if self.line.serial is not None:
            try:
                self.calls.command('SETOUTPUTSTATE', {'port': 0xFF},
                                   time.monotonic() + FAREWELL, False)
            except LineError:
                pass
        self.line.close()


def main():
    parser = argparse.ArgumentParser(description='Bridge to an NXT.')
    parser.add_argument('port', help='device, or URL of pyserial')
    parser.add_argument('--baudrate', type=int, default=115200)
    options = parser.parse_args()
    output = Output(sys.stdout.buffer)
    if serial is None:
        output.say({'id': None, 'error': 'no_pyserial',
                    'message': str(MISSING), 'python': sys.executable})
        sys.exit(NO_PYSERIAL)
    # The interrupt key of a terminal is for the person who sits there.
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    bridge = Bridge(Line(options.port, options.baudrate), output)
    threading.Thread(target=bridge.listen, args=(sys.stdin.buffer,),
                     daemon=True).start()
    bridge.serve()
    sys.stdout.flush()
    os._exit(0)                         # the other thread may be reading


if __name__ == '__main__':
    main()
