"""What can be plugged into a sensor port.

Analog devices have an AD value (0 to 1023) that does not depend on what the
port is set to; digital ones have an I2C address and registers."""

OPEN_CIRCUIT = 1023

# What the firmware takes for dark and for the range, per type of sensor.
LIGHT_ZERO, LIGHT_RANGE = 200, 68
SOUND_ZERO, SOUND_RANGE = 162, 83


def to_raw(level, zero, percent):
    """The AD value that the firmware normalizes to level."""
    return zero + ((1023 - level) * percent + 99) // 100


class Device:
    kind = 'none'
    address = None              # of a digital one

    def __init__(self, value=0):
        self.set(value)

    def set(self, value):
        self.value = value

    def raw(self, lamp=False):
        return OPEN_CIRCUIT


class Touch(Device):
    kind = 'touch'

    def raw(self, lamp=False):
        return 183 if self.value else OPEN_CIRCUIT


class Light(Device):
    """value: what is reflected with the lamp on; ambient without it."""
    kind = 'light'
    ambient = None

    def raw(self, lamp=False):
        level = self.value
        if not lamp and self.ambient is not None:
            level = self.ambient
        return to_raw(clip(level, 0, 1023), LIGHT_ZERO, LIGHT_RANGE)


class Sound(Device):
    kind = 'sound'

    def raw(self, lamp=False):
        return to_raw(clip(self.value, 0, 1023), SOUND_ZERO, SOUND_RANGE)


class Gyro(Device):
    """HiTechnic gyro, degrees per second."""
    kind = 'gyro'

    def raw(self, lamp=False):
        return clip(600 + self.value, 0, 1023)


class Colour(Device):
    """value: 1 black, 2 blue, 3 green, 4 yellow, 5 red, 6 white."""
    kind = 'colour'
    levels = {1: 60, 2: 180, 3: 220, 4: 420, 5: 300, 6: 560}

    def level(self):
        return self.levels.get(self.value, 0)


def clip(value, low, high):
    return max(low, min(high, int(value)))


def text(string, size=8):
    return string.encode().ljust(size, b'\0')[:size]


class Digital(Device):
    """Registers below 40 are a table of items, not one piece of memory:
    eight bytes from where a short item begins do not run into the next."""
    address = 0x02
    product = sensor = ''
    version = 'V1.0'
    items = {}

    def item(self, register):
        texts = {0x00: text(self.version), 0x08: text(self.product),
                 0x10: text(self.sensor)}
        return texts.get(register) or self.items.get(register, b'')

    def registers(self):
        """Bytes from register 40 on."""
        return b''

    def read(self, register, count):
        if register < 0x40:
            data = self.item(register)
        else:
            data = self.registers()[register - 0x40:]
        return data[:count].ljust(count, b'\0')

    def write(self, register, data):
        pass


class Ultrasonic(Digital):
    """value: centimetres, or a list of echoes from near to far."""
    kind = 'ultrasonic'
    product, sensor = 'LEGO', 'Sonar'
    items = {0x11: b'\0', 0x12: b'\1', 0x13: b'\1', 0x14: text('10E-2m', 7)}
    OFF, SINGLE, CONTINUOUS, CAPTURE, RESET = range(5)

    def __init__(self, value=255):
        self.mode = self.CONTINUOUS
        self.interval = 1
        self.shot = b'\xff' * 8
        super().__init__(value)

    def echoes(self):
        values = self.value if isinstance(self.value, list) else [self.value]
        data = bytes(clip(v, 0, 255) for v in values[:8])
        return data.ljust(8, b'\xff')

    def registers(self):
        echoes = self.shot
        if self.mode in (self.CONTINUOUS, self.CAPTURE):
            echoes = self.echoes()[:1].ljust(8, b'\xff')
        return bytes([self.interval, self.mode]) + echoes + b'\0\1\1'

    def write(self, register, data):
        if register == 0x40:
            self.interval = data[0]
        elif register == 0x41:
            self.command(data[0])

    def command(self, mode):
        if mode == self.SINGLE:
            self.shot = self.echoes()
        elif mode == self.OFF:
            self.shot = b'\xff' * 8
        self.mode = self.CONTINUOUS if mode == self.RESET else mode


class Compass(Digital):
    """value: degrees clockwise from north."""
    kind = 'compass'
    product, sensor, version = 'HiTechnc', 'Compass ', 'V1.23'
    mode = 0

    def registers(self):
        heading = int(self.value) % 360
        return bytes([0, self.mode, heading // 2, heading % 2,
                      heading & 255, heading >> 8])

    def write(self, register, data):
        if register == 0x41 and data[0] in (0x00, 0x43):
            self.mode = data[0]


class Accelerometer(Digital):
    """value: [x, y, z], 200 per g."""
    kind = 'accelerometer'
    product, sensor, version = 'HiTechnc', 'Accel.  ', 'V1.1'

    def registers(self):
        axes = [int(v) & 0x3ff for v in (list(self.value) + [0, 0, 0])[:3]]
        return (b'\0\0' + bytes(v >> 2 for v in axes)
                + bytes(v & 3 for v in axes))

    def set(self, value):
        self.value = value if isinstance(value, list) else [value]


class IRSeeker(Digital):
    """value: direction 0 (nothing seen) to 9."""
    kind = 'irseeker'
    address = 0x10
    product, sensor, version = 'HiTechnc', 'NewIRDir', 'V2.1'

    def registers(self):
        way = clip(self.value, 0, 9)
        near = [way and max(0, 200 - 80 * abs(way - 1 - 2 * i))
                for i in range(5)]
        mean = sum(near) // 5
        return (b'\0\0' + bytes([way] + near + [mean])
                + bytes([way] + near))


KINDS = {cls.kind: cls for cls in (
    Device, Touch, Sound, Light, Ultrasonic, Compass, Colour, Gyro,
    Accelerometer, IRSeeker)}


def parse(words):
    """A value from a line or an option."""
    numbers = [float(w) for w in words]
    numbers = [int(n) if n == int(n) else n for n in numbers]
    return numbers[0] if len(numbers) == 1 else numbers
