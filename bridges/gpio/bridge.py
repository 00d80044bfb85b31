#!/usr/bin/env python3
"""Pins of a board, by gpiozero.

    python3 bridge.py [--factory NAME] [--w1 FOLDER]

NAME is a pin factory of gpiozero; `mock` simulates a Raspberry Pi.  FOLDER is
where the kernel shows the devices on its 1-Wire lines.  See ../lib/helper.py
for how it is asked.  `do` is one of

    open   pin kind, and what the class of the kind in KINDS takes
    close  pin
    read   pin
    write  pin value
    drive  pin value        what is outside a simulated board sets an input

`pin` is a name, the request `open` says of what.  An input is said by

    edge   pin value        it has another value, and keeps it for `debounce`

Edges go to Prolog in the thread of gpiozero in which they come.  A pin that a
restarted bridge is asked to open, without an answer, and cannot, is said by

    missing   pin message

and is tried again when it is needed.  Whatever a device raises is an answer.
"""

import argparse
import concurrent.futures
import os
import re
import sys
import threading
import warnings

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)),
                                '..', 'lib'))
from helper import BadRequest, Helper, Refusal, Unfit, \
    text                                                       # noqa: E402

try:
    import gpiozero
except ImportError as problem:
    gpiozero, MISSING = None, problem

W1 = '/sys/bus/w1/devices'
LONGEST_FILE = 64                   # bytes of a temperature


def number(request, field, least, most):
    value = request.get(field)
    if isinstance(value, bool) or not isinstance(value, (int, float)) \
            or not least <= value <= most:
        raise BadRequest('%s: not a number from %g to %g'
                         % (field, least, most))
    return value


def choice(request, field, values):
    value = request.get(field, values[0])
    if value not in values:
        raise BadRequest('%s: %r is not known' % (field, value))
    return value


def level(value):
    if value not in (0, 1):
        raise Refusal('value', 'neither 0 nor 1')
    return value


class Pin:
    """One of gpiozero's devices."""

    device = None

    def close(self):
        self.device.close()

    def write(self, _value):
        raise Refusal('direction', 'it cannot be written')

    def drive(self, _value):
        raise Refusal('direction', 'it is no input')


class Output(Pin):
    def __init__(self, request, _board):
        self.device = gpiozero.DigitalOutputDevice(
            request.get('number'),
            active_high=choice(request, 'active', ('high', 'low')) == 'high',
            initial_value=bool(number(request, 'initial', 0, 1)))

    def read(self):
        return int(self.device.value)

    def write(self, value):
        self.device.value = level(value)


class Pwm(Pin):
    def __init__(self, request, _board):
        self.device = gpiozero.PWMOutputDevice(
            request.get('number'),
            active_high=choice(request, 'active', ('high', 'low')) == 'high',
            initial_value=number(request, 'initial', 0, 1),
            frequency=number(request, 'frequency', 1, 10000))

    def read(self):
        return self.device.value

    def write(self, value):
        if not 0 <= value <= 1:
            raise Refusal('value', 'not from 0 to 1')
        self.device.value = value


class Input(Pin):
    """gpiozero calls a pin with a pull-up active when it is low."""

    def __init__(self, request, board):
        pull = choice(request, 'pull', ('none', 'up', 'down'))
        self.low = choice(request, 'active', ('high', 'low')) == 'low'
        self.inverted = self.low != (pull == 'up')
        self.device = gpiozero.DigitalInputDevice(
            request.get('number'),
            pull_up={'none': None, 'up': True, 'down': False}[pull],
            active_state=True if pull == 'none' else None)
        name, debounce = request['pin'], number(request, 'debounce', 0, 60)

        def say(value):
            board.event('edge', pin=name, value=value)

        self.settling = Settling(debounce, self.read(), say) \
            if debounce else None
        change = self.settling.change if debounce else say
        self.device.when_activated = lambda: change(self.value(1))
        self.device.when_deactivated = lambda: change(self.value(0))

    def value(self, active):
        return int(active) ^ self.inverted

    def read(self):
        return self.value(self.device.value)

    def drive(self, value):
        pin = self.device.pin
        if not hasattr(pin, 'drive_high'):
            raise Refusal('real', 'it is no simulated pin')
        if level(value) != self.low:
            pin.drive_high()
        else:
            pin.drive_low()

    def close(self):
        if self.settling:
            self.settling.close()
        super().close()


class Settling:
    """Says a value once it has not changed for some seconds."""

    def __init__(self, seconds, value, say):
        self.seconds, self.said, self.say = seconds, value, say
        self.value, self.closed = value, False
        self.changes, self.wake = 0, threading.Condition()
        threading.Thread(target=self.run, daemon=True).start()

    def change(self, value):
        with self.wake:
            self.value, self.changes = value, self.changes + 1
            self.wake.notify()

    def close(self):
        with self.wake:
            self.closed = True
            self.wake.notify()

    def run(self):
        while True:
            with self.wake:
                self.wake.wait_for(lambda: self.changes or self.closed)
                while self.changes and not self.closed:
                    self.changes = 0
                    self.wake.wait_for(lambda: self.changes or self.closed,
                                       self.seconds)
                if self.closed:
                    return
                changed, self.said = self.value != self.said, self.value
            if changed:
                self.say(self.said)


class Thermometer(Pin):
    """A DS18B20, which needs 0.75 s; simulated, it tells what was set.

    Its thread is its own: others do not wait for one that hangs.
    """

    def __init__(self, request, board):
        self.board, self.value = board, 20.0
        self.thread = concurrent.futures.ThreadPoolExecutor(1)
        name = request.get('number')
        if not re.fullmatch(r'[0-9a-f]{2}-[0-9a-f]{12}', str(name)):
            raise Refusal('no_pin', 'not the name of a 1-Wire device')
        self.file = os.path.join(board.w1 or W1, name, 'temperature')
        if not board.simulated and not os.path.exists(self.file):
            raise Refusal('no_pin', '%s does not exist' % self.file)

    def read(self):
        if self.board.simulated:
            return self.value
        try:
            with open(self.file, 'rb') as stream:
                return int(stream.read(LONGEST_FILE)) / 1000
        except (OSError, ValueError) as problem:
            raise Refusal('silent', str(problem)) from None

    def drive(self, value):
        if not self.board.simulated:
            raise Refusal('real', 'it is no simulated thermometer')
        self.value = float(value)

    def close(self):
        self.thread.shutdown(wait=False)


KINDS = {'output': Output, 'pwm': Pwm, 'input': Input,
         'thermometer': Thermometer}


class Board(Helper):
    def __init__(self, w1):
        super().__init__()
        self.w1, self.simulated = w1, w1 is None
        self.pins = {}
        self.missing = {}                   # name: request that opens it

    def do_open(self, request, _deadline):
        name, kind = text(request, 'pin'), text(request, 'kind')
        if kind not in KINDS:
            raise BadRequest('kind: %r is not known' % kind)
        self.missing.pop(name, None)
        if name in self.pins:               # of a caller that has given up
            self.pins.pop(name).close()
        try:
            self.pins[name] = self.device(request)
        except Exception as problem:
            if 'id' in request:
                raise
            self.missing[name] = request
            self.event('missing', pin=name, message=str(problem))
        return {}

    def device(self, request):
        try:
            return KINDS[request['kind']](request, self)
        except gpiozero.GPIOPinInUse as problem:
            raise Refusal('in_use', str(problem)) from None
        except (gpiozero.PinInvalidPin, gpiozero.PinPWMUnsupported,
                gpiozero.PinFixedPull) as problem:
            raise Refusal('no_pin', str(problem)) from None
        except (gpiozero.BadPinFactory, gpiozero.PinUnknownPi) as problem:
            raise Refusal('no_pins', str(problem)) from None
        except Exception as problem:        # of the library of the board
            if 'busy' in str(problem):
                raise Refusal('in_use', str(problem)) from None
            raise

    def pin(self, request):
        name = text(request, 'pin')
        if name in self.missing:
            self.pins[name] = self.device(self.missing[name])
            del self.missing[name]
        if name not in self.pins:
            raise BadRequest('pin: there is no %r' % name)
        return self.pins[name]

    def do_close(self, request, _deadline):
        if self.missing.pop(text(request, 'pin'), None) is None:
            self.pin(request).close()
            del self.pins[request['pin']]
        return {}

    def do_read(self, request, _deadline):
        pin = self.pin(request)
        if isinstance(pin, Thermometer):
            return self.later(pin.thread, request, pin.read)
        return pin.read()

    def do_write(self, request, _deadline):
        self.pin(request).write(number(request, 'value', -1e6, 1e6))
        return {}

    def do_drive(self, request, _deadline):
        self.pin(request).drive(number(request, 'value', -1e6, 1e6))
        return {}

    def do_quit(self, _request, _deadline):
        self.abandoned()
        return {}

    def abandoned(self):
        """Pins are inputs again, as before; one that fails keeps no other."""
        for name, pin in self.pins.items():
            try:
                pin.close()
            except Exception as problem:
                print('%s: not released: %s' % (name, problem),
                      file=sys.stderr)


def main():
    parser = argparse.ArgumentParser(description='Pins for agents.')
    parser.add_argument('--factory')
    parser.add_argument('--w1')
    given = parser.parse_args()
    if given.factory:
        os.environ['GPIOZERO_PIN_FACTORY'] = given.factory
    warnings.simplefilter('ignore', gpiozero.PinFactoryFallback)
    os.environ.setdefault('GPIOZERO_MOCK_PIN_CLASS', 'mockpwmpin')
    simulated = os.environ.get('GPIOZERO_PIN_FACTORY') == 'mock'
    Board(given.w1 or (None if simulated else W1)).run()


if __name__ == '__main__':
    main() if gpiozero else Unfit('no_gpiozero', MISSING).run()
