"""A sensor port: type, mode, and what the firmware makes of the AD value."""

from .devices import (Colour, Device, LIGHT_RANGE, LIGHT_ZERO, OPEN_CIRCUIT,
                      SOUND_RANGE, SOUND_ZERO)
from .lowspeed import LowSpeed

LIGHT_ACTIVE, LIGHT_INACTIVE, SOUND_DB, SOUND_DBA = 5, 6, 7, 8
RCX_LIGHT, LOWSPEED = 3, (0x0A, 0x0B, 0x0C)
COLOUR_FULL, COLOUR_TYPES = 0x0D, (0x0D, 0x0E, 0x0F, 0x10, 0x11, 0x12)
RCX_LIGHT_ZERO, RCX_LIGHT_RANGE = 476, 41

BOOLEAN, TRANSITIONS, PERIODS, PERCENT = 0x20, 0x40, 0x60, 0x80
CELSIUS, FAHRENHEIT = 0xA0, 0xC0
BOUNCING = 0.1                  # seconds in which a switch changes once
FALSE_ABOVE, TRUE_BELOW = 1023 * 45 // 100, 1023 * 55 // 100

# Ticks of the input module, about 1 ms each, until a new type is valid.
SETTLING = {SOUND_DB: 0.3, SOUND_DBA: 0.3,
            **{colour: 0.4 for colour in COLOUR_TYPES}}


def full_scale(raw, zero, percent):
    level = min(1023, max(0, raw - zero) * 100 // percent)
    return 1023 - level


class Input:
    def __init__(self, device=None, now=0.0):
        self.device = device or Device()
        self.type = self.mode = 0
        self.valid_at = now + 0.02
        self.boolean = False
        self.last = 0
        self.edges = self.counted = 0
        self.steady_at = 0.0
        self.lowspeed = LowSpeed(self)

    def setup(self, kind, mode, now):
        if kind != self.type:
            self.valid_at = now + SETTLING.get(kind, 0.02)
            self.edges = self.counted = 0
            self.steady_at = now
        elif now >= self.valid_at:
            self.valid_at = now + 0.001
        self.type, self.mode = kind, mode

    def valid(self, now):
        return now >= self.valid_at

    def digital(self):
        return self.type in LOWSPEED

    def normalized(self, raw):
        if self.type in (LIGHT_ACTIVE, LIGHT_INACTIVE):
            return full_scale(raw, LIGHT_ZERO, LIGHT_RANGE)
        if self.type in (SOUND_DB, SOUND_DBA):
            return full_scale(raw, SOUND_ZERO, SOUND_RANGE)
        if self.type == RCX_LIGHT:
            return full_scale(raw, RCX_LIGHT_ZERO, RCX_LIGHT_RANGE)
        return raw

    def levels(self):
        """AD value and normalized value."""
        if self.type == 0 or self.digital():
            return 0, 0
        if self.type in COLOUR_TYPES:
            level = (self.device.level()
                     if isinstance(self.device, Colour) else 0)
            return level, level
        if isinstance(self.device, Colour):
            return OPEN_CIRCUIT, self.normalized(OPEN_CIRCUIT)
        raw = self.device.raw(lamp=self.type == LIGHT_ACTIVE)
        return raw, self.normalized(raw)

    def sense(self, level):
        """The boolean that the firmware keeps beside every value."""
        slope = self.mode & 0x1f
        change, self.last = self.last - level, level
        if not slope:
            high, low = FALSE_ABOVE, TRUE_BELOW
        else:
            high, low = 1023 - slope, slope
        if level > high:
            return False
        if level < low:
            return True
        if slope and abs(change) > slope:
            return change > 0
        return self.boolean

    def sample(self, now):
        """Counts edges; to be called every few milliseconds."""
        if not (self.type and self.valid(now)) or self.digital():
            return
        before, self.boolean = self.boolean, self.sense(self.levels()[1])
        if now >= self.steady_at and before != self.boolean:
            self.steady_at = now + BOUNCING
            self.edges += 1
            counting = self.mode & 0xe0
            if counting == TRANSITIONS:
                self.counted += 1
            elif counting == PERIODS and self.edges % 2 == 0:
                self.counted += 1

    def scaled(self, level):
        mode = self.mode & 0xe0
        if self.type == COLOUR_FULL:
            seen = isinstance(self.device, Colour)
            return int(self.device.value) if seen else 1
        if mode == BOOLEAN:
            return int(self.boolean if self.mode & 0x1f
                       else self.sense(level))
        if mode in (TRANSITIONS, PERIODS):
            return self.counted
        if mode == PERCENT:
            return level * 100 // 1023
        if mode == CELSIUS:
            return level * 900 // 1023 - 200
        if mode == FAHRENHEIT:
            return 180 * (level * 900 // 1023 - 200) // 100 + 320
        return level

    def reset_scaled(self):
        self.counted = self.edges = 0

    def values(self, now):
        """valid, raw, normalized, scaled"""
        if not self.valid(now):
            return False, 0, 0, 0
        raw, level = self.levels()
        return True, raw, level, self.scaled(level)
