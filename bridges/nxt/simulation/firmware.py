"""A brick: what LEGO's firmware does with the telegrams it gets."""

from . import direct, system
from .devices import KINDS
from .flash import Flash
from .inputs import Input
from .motors import FULL_BATTERY, Motors
from .telegrams import INSANE, Insane, Request

STEP = 0.005                    # seconds of physics
NO_REPLY = 0x80
UNKNOWN_DIRECT, UNKNOWN_SYSTEM = 0xBE, 0x8A
USUAL = ('touch', 'sound', 'light', 'ultrasonic')
QUIET = {'sound': 40, 'light': 450}


def device(kind, value=None):
    if value is None:
        value = QUIET.get(kind)
    return KINDS[kind]() if value is None else KINDS[kind](value)


class Brick:
    """All that happens, happens at `time`, which only advance() moves.

    A world drives the motors of its bricks itself (driven=True)."""

    def __init__(self, name='NXT', kinds=USUAL, gains=(1.0, 1.0, 1.0),
                 number=1, driven=False):
        self.name = self.label = name
        self.full_battery = FULL_BATTERY
        self.address = bytes([0, 0x16, 0x53, 1, 2, number & 255])
        self.time = 0.0
        self.driven = driven
        self.gains = gains
        self.inputs = [Input(device(kind)) for kind in kinds]
        self.flash = Flash(system.MODULES)
        self.sounds = []
        self.telegrams = self.replies = 0
        self.restart()

    def restart(self):
        """Off and on again: only the files stay, and what is plugged in."""
        self.motors = Motors(self.gains)
        self.inputs = [Input(at.device, self.time) for at in self.inputs]
        self.flash.handles.clear()
        self.io_maps = {}
        self.program = None
        self.mailboxes = [[] for _ in range(direct.MAILBOXES)]
        self.set_battery(FULL_BATTERY)

    def set_battery(self, millivolts):
        self.millivolts = self.motors.battery = millivolts

    def plug(self, port, kind, value=None):
        self.inputs[port].device = device(kind, value)

    # ---- time

    def advance(self, now):
        """Steps motors and inputs up to now."""
        if not self.driven:
            while self.time + STEP <= now:
                if self.motors.at_rest():
                    skipped = (now - self.time) // STEP
                    self.time += skipped * STEP
                    self.sample()
                    break
                self.motors.step(STEP)
                self.tick(self.time + STEP)
        return self.time

    def tick(self, time):
        self.time = time
        self.sample()

    def sample(self):
        for port in self.inputs:
            port.sample(self.time)

    # ---- programs and sounds

    def start_program(self, name):
        self.stop_program()
        self.program = name

    def stop_program(self):
        """The mailboxes live only while a program runs."""
        self.program = None
        for box in self.mailboxes:
            box.clear()

    def sound(self, *what):
        self.sounds.append((self.time, *what))
        del self.sounds[:-1000]

    # ---- telegrams

    def handle(self, telegram, now):
        """The reply to a telegram, or None."""
        if len(telegram) < 2:
            return None
        kind, opcode = telegram[0] & ~NO_REPLY, telegram[1]
        if kind not in (0, 1) or telegram[0] & 0x7e:
            return None
        self.advance(now)
        late = self.time
        self.time = max(now, late)      # between two steps of the physics
        self.telegrams += 1
        status, data = self.execute(kind, opcode, telegram[2:])
        self.time = late
        if telegram[0] & NO_REPLY:
            return None
        self.replies += 1
        return bytes([2, opcode, status]) + data

    def execute(self, kind, opcode, data):
        table = system.COMMANDS if kind else direct.COMMANDS
        command = table.get(opcode)
        if command is None:
            return (UNKNOWN_SYSTEM if kind else UNKNOWN_DIRECT), b''
        try:
            return command(self, Request(data))
        except Insane:
            return INSANE, b''
