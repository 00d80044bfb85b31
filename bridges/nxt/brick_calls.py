"""What is asked of a brick, in one go each: commands, sensors, I2C.

Requests of several agents must not come between the telegrams of one I2C
transaction, or between setting a sensor up and reading it.  So these are
made here, not in Prolog.
"""

import time

import telegram
from line import LineError

LOWSPEED_9V = 0x0B
PENDING, NOT_CONFIGURED = 0x20, 0xE0
SETTLE = 0.1                            # seconds, for an I2C sensor
PAUSE = 0.005                           # seconds, between two looks


class Refused(LineError):
    """The brick answered with a status other than success."""

    def __init__(self, command, code):
        name = telegram.status_name(code)
        super().__init__('refused',
                         'the brick says %s' % name.replace('_', ' '),
                         command=command, code=code, status=name)
        self.code = code


class BrickCalls:
    """The calls of one brick, over a Line."""

    def __init__(self, line):
        self.line = line
        self.modes = {}                 # port -> (type, mode)
        self.opening = 0                # of the line, when they were set

    def command(self, name, values, deadline, reply=True):
        """The values a command replies, {} if no reply is asked for."""
        request = telegram.encode_request(name, values, reply)
        answer = self.line.exchange(request, deadline)
        if answer is None:
            return {}
        try:
            status, result = telegram.decode_reply(name, answer)
        except telegram.BadTelegram as problem:
            self.line.in_step = False
            raise LineError('garbage', str(problem)) from None
        if status != 0:
            raise Refused(name, status)
        return result

    def open(self, deadline):
        self.line.open()
        return self.command('GETFIRMWAREVERSION', {}, deadline)

    def telegram(self, name, values, reply, deadline):
        if name == 'SETINPUTMODE':
            self.modes.clear()
        return self.command(name, values, deadline, reply)

    def show(self, pieces, deadline):
        for piece in pieces:
            self.command('WRITEIOMAP', piece, deadline)
        return {}

    # Sensors

    def mode_is_set(self, port, kind, mode):
        """Whether the sensor is set up; a brick may forget with the line."""
        if self.opening != self.line.openings:
            self.modes.clear()
            self.opening = self.line.openings
        return self.modes.get(port) == (kind, mode)

    def set_mode(self, port, kind, mode, deadline):
        self.modes.pop(port, None)
        self.command('SETINPUTMODE',
                     {'port': port, 'type': kind, 'mode': mode}, deadline)
        self.opening = self.line.openings
        self.modes[port] = (kind, mode)

    def sensor(self, port, kind, mode, deadline):
        """The values of a port, as soon as they are valid.

        A brick that was switched off and on has forgotten the mode.
        """
        if not self.mode_is_set(port, kind, mode):
            self.set_mode(port, kind, mode, deadline)
        while True:
            values = self.command('GETINPUTVALUES', {'port': port}, deadline)
            if (values['type'], values['mode']) != (kind, mode):
                self.set_mode(port, kind, mode, deadline)
            elif values['valid']:
                return values
            self.pause(deadline, 'the sensor gives nothing valid')

    def pause(self, deadline, why):
        time.sleep(PAUSE)
        if time.monotonic() >= deadline:
            raise LineError('timeout', why)

    # I2C

    def i2c(self, port, data, rx, deadline):
        """Send bytes to a sensor, get so many back."""
        try:
            self.i2c_write(port, data, rx, deadline)
            self.i2c_wait(port, rx, deadline)
            if rx == 0:
                return b''
            values = self.command('LSREAD', {'port': port}, deadline)
        except LineError:
            self.modes.pop(port, None)      # begin afresh
            raise
        if len(values['data']) < rx:
            self.modes.pop(port, None)
            raise LineError('garbage', '%d bytes of %d'
                            % (len(values['data']), rx))
        return values['data'][-rx:]         # others may be left over

    def i2c_write(self, port, data, rx, deadline):
        if not self.mode_is_set(port, LOWSPEED_9V, 0):
            self.i2c_begin(port, deadline)
        again = True
        while True:
            try:
                self.command('LSWRITE', {'port': port, 'data': data,
                                         'rx': rx}, deadline)
                return
            except Refused as refused:
                late = time.monotonic() >= deadline - 2 * SETTLE
                if refused.code != NOT_CONFIGURED or late:
                    raise
            if again:                       # forgotten, or only busy?
                self.i2c_begin(port, deadline)
                again = False
            time.sleep(PAUSE)

    def i2c_begin(self, port, deadline):
        """Set up the port, and drop the answer that another client left.

        Nothing else is read before the first LSWRITE.
        """
        self.set_mode(port, LOWSPEED_9V, 0, deadline)
        time.sleep(SETTLE)
        try:
            if self.i2c_ready(port, deadline) > 0:
                self.command('LSREAD', {'port': port}, deadline)
        except Refused:                     # as the last LSWRITE failed
            pass

    def i2c_ready(self, port, deadline):
        """How many bytes can be read; -1 while they are coming."""
        try:
            return self.command('LSGETSTATUS', {'port': port},
                                deadline)['ready']
        except Refused as refused:
            if refused.code != PENDING:
                raise
            return -1

    def i2c_wait(self, port, rx, deadline):
        while self.i2c_ready(port, deadline) < rx:
            self.pause(deadline, 'the sensor does not answer')
