"""What the sensors of a robot find in the world."""

import math

from .lanes import wrap

COLOURS = {'black': 1, 'blue': 2, 'green': 3, 'yellow': 4, 'red': 5,
           'white': 6}
BRIGHTNESS = {1: 250, 2: 330, 3: 380, 4: 560, 5: 480, 6: 620}
BLACK, WHITE = 1, 6
LINE = 0.010                    # half the width of a line, metres
MARKER = 0.03                   # radius
EYES, ASIDE = 0.06, 0.015       # where floor sensors look
BODY = 0.09                     # radius of a robot, for echoes
FARTHEST = 2.55


def to_segment(point, begin, end):
    """Distance of a point from a straight piece."""
    (px, py), (x0, y0), (x1, y1) = point, begin, end
    dx, dy = x1 - x0, y1 - y0
    size = dx * dx + dy * dy
    t = ((px - x0) * dx + (py - y0) * dy) / size if size else 0.0
    t = max(0.0, min(1.0, t))
    return math.hypot(px - x0 - t * dx, py - y0 - t * dy)


class Floor:
    """White, with black lines and coloured markers on it."""

    def __init__(self, lines, markers):
        self.pieces = [piece for line in lines
                       for piece in zip(line, line[1:])]
        self.markers = [(tuple(m['at']), COLOURS[m['colour']])
                        for m in markers]

    def colour(self, point):
        for at, colour in self.markers:
            if math.dist(at, point) <= MARKER:
                return colour
        if any(to_segment(point, *piece) <= LINE for piece in self.pieces):
            return BLACK
        return WHITE


def ray_to_segment(origin, way, begin, end):
    """How far along the ray it is, or None."""
    (ox, oy), (wx, wy), (x0, y0), (x1, y1) = origin, way, begin, end
    dx, dy = x1 - x0, y1 - y0
    across = wx * dy - wy * dx
    if abs(across) < 1e-12:
        return None
    t = ((x0 - ox) * dy - (y0 - oy) * dx) / across
    u = ((x0 - ox) * wy - (y0 - oy) * wx) / across
    return t if t >= 0 and 0 <= u <= 1 else None


def ray_to_circle(origin, way, centre, radius):
    dx, dy = centre[0] - origin[0], centre[1] - origin[1]
    along = dx * way[0] + dy * way[1]
    aside = dx * dx + dy * dy - along * along
    if aside > radius * radius:
        return None
    near = along - math.sqrt(radius * radius - aside)
    return near if near >= 0 else None


def echo(arena, robot):
    """Metres to what is straight ahead of the front of a robot."""
    origin = robot.front()
    angle = math.radians(robot.heading)
    way = (math.cos(angle), math.sin(angle))
    found = [ray_to_circle(origin, way, (other.x, other.y), BODY)
             for other in arena.robots.values() if other is not robot]
    found += [ray_to_segment(origin, way, *piece)
              for piece in obstacles(arena, robot)]
    return min((d for d in found if d is not None), default=None)


def obstacles(arena, robot):
    """Walls, boxes, and a pole that is low enough to be seen."""
    w, h = arena.size
    walls = [(0, 0), (w, 0), (w, h), (0, h)]
    outlines = [walls] + [box.corners() for box in arena.boxes.values()]
    for outline in outlines:
        yield from zip(outline, outline[1:] + outline[:1])
    if arena.pole and not robot.holding and arena.pole.height() < 0.06:
        yield arena.pole.ends()


def sense(arena, robot):
    """Gives the devices of a robot their values."""
    colours = [p for p in robot.brick.inputs if p.device.kind == 'colour']
    for side, port in zip((ASIDE, -ASIDE), colours):
        port.device.set(arena.floor.colour(robot.front(EYES, side)))
    for port in robot.brick.inputs:
        reading = READINGS.get(port.device.kind)
        if reading:
            port.device.set(reading(arena, robot))


def read_ultrasonic(arena, robot):
    far = echo(arena, robot)
    return 255 if far is None or far > FARTHEST else round(100 * far)


def read_light(arena, robot):
    level = BRIGHTNESS[arena.floor.colour(robot.front(EYES))]
    return level + robot.random.randint(-4, 4)


def read_compass(arena, robot):
    return round(90 - wrap(robot.heading)) % 360


READINGS = {'touch': lambda arena, robot: int(robot.touching),
            'light': read_light, 'ultrasonic': read_ultrasonic,
            'compass': read_compass}
