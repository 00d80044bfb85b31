"""The three motors of a brick and the firmware that drives them.

Counts are degrees. Speed follows the power with a short delay; a load is a
fraction of the torque at which the motor stalls. An unregulated motor turns
slower under load and with a weak battery, a regulated one as long as there
is power left keeps its speed."""

import math

MOTORON, BRAKE, REGULATED = 1, 2, 4
REG_NONE, REG_SPEED, REG_SYNC = 0, 1, 2
IDLE, RAMP_UP, RUNNING, RAMP_DOWN = 0x00, 0x10, 0x20, 0x40

DEGREES_PER_PERCENT = 9.5       # per second, on a full battery
FULL_BATTERY = 7800             # millivolts
DRIVEN, COASTING, BRAKED = 0.08, 0.06, 0.02     # time constants, seconds
LEAST_POWER = 10                # where ramps begin and end


def sign(x):
    return (x > 0) - (x < 0)


class Motor:
    def __init__(self, gain=1.0):
        self.gain = gain        # of this one motor, unregulated
        self.load = 0.0
        self.speed = 0.0        # degrees per second
        self.count = 0.0        # degrees since the brick was started
        self.block_zero = 0.0
        self.rotation_zero = 0.0
        self.power = self.mode = self.regulation = self.turn = 0
        self.run_state = IDLE
        self.limit = 0
        self.target = 0.0       # count at which a limited run ends
        self.ramp_from = (0.0, 0.0)     # count, power

    def command(self, power, mode, regulation, turn, run_state, limit):
        before = self.duty()
        self.power, self.mode, self.regulation = power, mode, regulation
        self.turn, self.run_state, self.limit = turn, run_state, limit
        if run_state in (RAMP_UP, RAMP_DOWN):
            self.begin_ramp(before)
        # A limit counts from where the last one ended, so that the
        # overshoot of one run is made up for in the next.
        if limit and mode & MOTORON and run_state != IDLE:
            way = sign(power) or sign(before) or -1
            self.target += way * limit

    def begin_ramp(self, before):
        rising = self.run_state == RAMP_UP
        start = before if sign(before) == sign(self.power) or not rising else 0
        faster = abs(self.power) > abs(start)
        if faster != rising:
            self.run_state = RUNNING
        floor = LEAST_POWER * (sign(self.power) or sign(start))
        if rising and abs(start) < LEAST_POWER:
            start = floor
        self.ramp_from = (self.count, start)

    def active(self):
        return bool(self.mode & MOTORON) and self.run_state != IDLE

    def synchronous(self):
        return (self.active() and self.mode & REGULATED
                and self.regulation == REG_SYNC)

    def duty(self):
        """The power asked for at this moment, -100 to 100."""
        if not self.active():
            return 0.0
        if self.run_state == RUNNING or not self.limit:
            return float(self.power)
        begin, start = self.ramp_from
        whole = self.target - begin
        part = 1.0 if not whole else (self.count - begin) / whole
        duty = start + (self.power - start) * max(0.0, min(1.0, part))
        least = LEAST_POWER * (sign(self.power) or sign(start))
        return duty if abs(duty) >= LEAST_POWER else float(least)

    def reachable(self, duty, battery):
        """The speed for a power, degrees per second, regulated or not."""
        volts = battery / FULL_BATTERY
        most = 100 * max(0.0, 1 - self.load) * volts * self.gain
        if self.mode & REGULATED and self.regulation in (REG_SPEED, REG_SYNC):
            percent = min(abs(duty), most)
        else:
            percent = (abs(duty) - 100 * self.load) * volts * self.gain
        return sign(duty) * max(0.0, percent) * DEGREES_PER_PERCENT

    def aim(self, battery):
        """The speed to go for, and the time constant."""
        duty = self.duty()
        if duty:
            return self.reachable(duty, battery), DRIVEN
        held = self.active() and self.mode & BRAKE
        return 0.0, BRAKED if held else COASTING

    def approach(self, aim, constant, dt):
        """Degrees turned in dt if nothing is in the way."""
        fade = math.exp(-dt / constant)
        gap = self.speed - aim
        self.speed = aim + gap * fade
        if abs(self.speed) < 0.5 and not aim:
            self.speed = 0.0
        return aim * dt + gap * constant * (1 - fade)

    def turned(self, degrees, freely=1.0):
        """The shaft has turned; freely < 1 if something stopped it."""
        self.count += degrees * freely
        self.speed *= freely
        if self.active() and not self.limit and self.power:
            self.target = self.count

    def reached(self):
        """Has a limited run come to its end?"""
        way = sign(self.duty())
        return (self.limit and self.active() and way
                and (self.count - self.target) * way >= 0)

    def stop(self):
        self.run_state = IDLE           # power, mode and limit still show

    def at_rest(self):
        return not self.speed and not self.duty()

    def reset(self, relative):
        if relative:
            self.block_zero = self.count
        else:
            self.rotation_zero = self.count

    def counters(self):
        """tacho, block and rotation count"""
        return (int(self.count), int(self.count - self.block_zero),
                int(self.count - self.rotation_zero))


class Motors:
    """A, B and C. Of two in sync the turn ratio slows the inner one."""

    def __init__(self, gains=(1.0, 1.0, 1.0)):
        self.motors = [Motor(gain) for gain in gains]
        self.battery = FULL_BATTERY

    def __getitem__(self, port):
        return self.motors[port]

    def pair(self):
        both = [m for m in self.motors if m.synchronous()]
        return both[:2] if len(both) >= 2 else None

    def wish(self, dt):
        """Degrees that A, B and C would turn in dt."""
        aims = [m.aim(self.battery) for m in self.motors]
        pair = self.pair()
        if pair:
            speeds = self.pair_speeds(*pair)
            for motor, speed in zip(pair, speeds):
                aims[self.motors.index(motor)] = (speed, DRIVEN)
        return [m.approach(aim, constant, dt)
                for m, (aim, constant) in zip(self.motors, aims)]

    def pair_speeds(self, one, two):
        duties = pair_duties(one, two)
        ratios = [m.reachable(duty, self.battery) / duty
                  for m, duty in zip((one, two), duties) if duty]
        slower = min(ratios, default=0.0)
        return [slower * duty for duty in duties]

    def turn(self, degrees, freely=(1.0, 1.0, 1.0)):
        for motor, amount, free in zip(self.motors, degrees, freely):
            motor.turned(amount, free)
        pair = self.pair()
        for motor in self.motors:
            if motor.reached() and not (pair and motor in pair):
                motor.stop()
        if pair:
            self.end_pair(*pair)

    def end_pair(self, one, two):
        """Together: when the outer one is there, or either going straight."""
        if one.turn:
            outer = one if inner_is_second(one) else two
            ended = outer.reached()
        else:
            ended = one.reached() or two.reached()
        if ended:
            for motor in (one, two):
                motor.stop()
                motor.target = motor.count if one.turn else motor.target

    def step(self, dt):
        self.turn(self.wish(dt))

    def at_rest(self):
        return all(m.at_rest() for m in self.motors)


def inner_is_second(one):
    return (one.turn < 0) == (one.power >= 0)


def pair_duties(one, two):
    power, ratio = one.duty(), abs(one.turn)
    slow = power * (1 - 2 * min(ratio, 100) / 100)
    return (power, slow) if inner_is_second(one) else (slow, power)
