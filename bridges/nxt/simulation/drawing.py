"""Pictures of a world: one moment, or a whole run that moves (SMIL)."""

from .lanes import wrap
from .senses import LINE, MARKER

SCALE = 250                     # pixels per metre
LONGEST = 40.0                  # seconds that a picture runs; faster if more
SIDE = 90                       # height of the side view of the pole
TALLER = 2                      # heights in it, against lengths
HEAD = ('<svg xmlns="http://www.w3.org/2000/svg" width="{w}" height="{h}" '
        'viewBox="0 0 {w} {h}" font-family="sans-serif" font-size="12">\n'
        '<rect width="{w}" height="{h}" fill="#f4f2ec"/>\n')
FILLS = {'carrier': '#4a7ab5', 'pusher': '#5a9a5a', 'plain': '#999'}


class Drawing:
    """Of a list of moments; the last of them if it does not move."""

    def __init__(self, arena, moments):
        self.arena, self.moments = arena, moments
        self.moves = len(moments) > 1
        self.begin, self.end = moments[0]['time'], moments[-1]['time']
        length = max(self.end - self.begin, 1e-3)
        self.seconds = min(length, LONGEST)
        self.keys = ';'.join(
            number((m['time'] - self.begin) / length, 4) for m in moments)
        self.width, self.floor = (round(SCALE * v) for v in arena.size)
        self.side = SIDE if arena.pole else 0

    def svg(self):
        height = self.floor + self.side + 24
        parts = [HEAD.format(w=self.width, h=height), *self.ground()]
        for name in self.names('boxes'):
            parts += self.box(name)
        if self.arena.pole:
            parts += self.pole() + self.side_view()
        for name in self.names('robots'):
            parts += self.robot(name)
        return '\n'.join([*parts, *self.clock(height), '</svg>\n'])

    def names(self, what):
        return list(dict.fromkeys(n for m in self.moments for n in m[what]))

    # ---- what does not move

    def ground(self):
        for line in self.arena.lines:
            points = ' '.join(f'{self.x(x)},{self.y(y)}' for x, y in line)
            yield (f'<polyline points="{points}" fill="none" stroke="#222" '
                   f'stroke-width="{round(2 * LINE * SCALE)}" '
                   'stroke-linejoin="round"/>')
        for marker in self.arena.markers:
            x, y = marker['at']
            yield (f'<circle cx="{self.x(x)}" cy="{self.y(y)}" '
                   f'r="{number(MARKER * SCALE)}" '
                   f'fill="{marker["colour"]}"/>')

    def x(self, x):
        return number(x * SCALE)

    def y(self, y):
        return number(self.floor - y * SCALE)

    # ---- what moves

    def series(self, what, name):
        """What is known of it at every moment; nothing is as before."""
        known = [m[what].get(name) for m in self.moments]
        last = next(k for k in known if k is not None)
        filled = []
        for k in known:
            last = k if k is not None else last
            filled.append(last)
        return filled, [k is not None for k in known]

    def animate(self, attribute, values, discrete=False):
        if not self.moves or len(set(values)) == 1:
            return ''
        mode = ' calcMode="discrete"' if discrete else ''
        return (f'<animate attributeName="{attribute}" {self.timing(values)}'
                f'{mode}/>')

    def transform(self, kind, values):
        if not self.moves or len(set(values)) == 1:
            return ''
        return ('<animateTransform attributeName="transform" '
                f'type="{kind}" {self.timing(values)}/>')

    def timing(self, values):
        return (f'dur="{number(self.seconds)}s" repeatCount="indefinite" '
                f'keyTimes="{self.keys}" values="{";".join(values)}"')

    def shown(self, there):
        """Only while it is there."""
        return self.animate('opacity', ['1' if t else '0' for t in there],
                            discrete=True)

    def robot(self, name):
        known, there = self.series('robots', name)
        places = [f'{self.x(k[0])} {self.y(k[1])}' for k in known]
        turns = [number(-h, 1) for h in unwrapped([k[2] for k in known])]
        touch = ['#d03030' if k[4] else '#ddd' for k in known]
        fill = FILLS[known[-1][3]]
        return [f'<g transform="translate({places[-1]})">',
                self.transform('translate', places), self.shown(there),
                f'<g transform="rotate({turns[-1]})">',
                self.transform('rotate', turns), shape(fill),
                f'<rect x="24" y="-9" width="5" height="18" '
                f'fill="{touch[-1]}" stroke="#333" stroke-width="0.5">',
                self.animate('fill', touch, discrete=True),
                '</rect></g>', f'<text y="4" text-anchor="middle" '
                f'fill="#fff" font-size="11">{name}</text></g>']

    def box(self, name):
        known, there = self.series('boxes', name)
        corners = [k[0] for k in known]
        points = [' '.join(f'{self.x(x)},{self.y(y)}' for x, y in c)
                  for c in corners]
        fills = [{'waiting': '#c9a66b', 'moving': '#e8b84a',
                  'arrived': '#9bb58a'}[k[3]] for k in known]
        middles = [middle(c) for c in corners]
        xs = [self.x(x) for x, _ in middles]
        ys = [self.y(y) for _, y in middles]
        return ['<g>', self.shown(there),
                f'<polygon points="{points[-1]}" fill="{fills[-1]}" '
                'stroke="#6b4e1e">', self.animate('points', points),
                self.animate('fill', fills, discrete=True), '</polygon>',
                f'<text x="{xs[-1]}" y="{ys[-1]}" text-anchor="middle" '
                f'fill="#333">{name}: {known[-1][1]}',
                self.animate('x', xs), self.animate('y', ys), '</text></g>']

    def pole(self):
        known = [m['pole'] for m in self.moments]
        columns = {'x1': [self.x(k[0][0][0]) for k in known],
                   'y1': [self.y(k[0][0][1]) for k in known],
                   'x2': [self.x(k[0][1][0]) for k in known],
                   'y2': [self.y(k[0][1][1]) for k in known],
                   'stroke': self.warning(known)}
        return self.line(columns, 7)

    def side_view(self):
        """The pole seen by the robots, heights magnified."""
        base = self.floor + SIDE - 14
        known = [m['pole'] for m in self.moments]
        length = self.arena.pole.length * SCALE
        left = (self.width - length) / 2
        rows = [[number(base - k[i] * SCALE * TALLER - 3)
                 for k in known] for i in (1, 2)]
        ground = (f'<line x1="{number(left - 20)}" y1="{base}" '
                  f'x2="{number(left + length + 20)}" y2="{base}" '
                  'stroke="#777"/>')
        text = (f'<text x="8" y="{self.floor + 18}" fill="#555">side view, '
                f'heights x {TALLER}; red: tilted by more than '
                f'{self.arena.pole.limit:g} degrees</text>')
        columns = {'x1': [number(left)], 'y1': rows[0],
                   'x2': [number(left + length)], 'y2': rows[1],
                   'stroke': self.warning(known)}
        return [ground, text] + self.line(columns, 6)

    def warning(self, known):
        return ['#d03030' if k[4] else '#8a5a2b' for k in known]

    def line(self, columns, width):
        now = ' '.join(f'{k}="{v[-1]}"' for k, v in columns.items())
        return [f'<line {now} stroke-width="{width}" '
                'stroke-linecap="round">',
                *(self.animate(k, v, k == 'stroke')
                  for k, v in columns.items()), '</line>']

    def clock(self, height):
        """A bar that grows, from the first second to the last."""
        widths = [number(self.width * (m['time'] - self.begin)
                         / max(self.end - self.begin, 1e-3))
                  for m in self.moments]
        yield (f'<rect x="0" y="{height - 5}" height="5" fill="#888" '
               f'width="{widths[-1] if self.moves else 0}">')
        yield self.animate('width', widths)
        yield '</rect>'
        text = (f'{self.begin:.1f} to {self.end:.1f} s' if self.moves
                else f'{self.end:.1f} s')
        yield (f'<text x="{self.width - 8}" y="{height - 9}" '
               f'text-anchor="end" fill="#555">{text}</text>')


def shape(fill):
    """A robot that looks along the x axis: wheels, body, arms."""
    wheel = ('<rect x="-7" y="{}" width="14" height="5" fill="#222" '
             'rx="2"/>')
    return (wheel.format(-19) + wheel.format(14)
            + f'<rect x="-16" y="-14" width="34" height="28" rx="4" '
              f'fill="{fill}" stroke="#333"/>'
              '<path d="M18,-6 L24,-6 M18,6 L24,6" stroke="#333" '
              'stroke-width="2"/>')


def middle(corners):
    return tuple(sum(c[i] for c in corners) / len(corners) for i in (0, 1))


def unwrapped(angles):
    """So that a turn from 179 to -179 degrees is one of 2."""
    found = [angles[0]]
    for angle in angles[1:]:
        found.append(found[-1] + wrap(angle - found[-1]))
    return found


def number(value, digits=1):
    text = f'{value:.{digits}f}'
    return text.rstrip('0').rstrip('.') if '.' in text else text


def frame(arena, moment):
    return Drawing(arena, [moment]).svg()


def picture(arena, moments):
    return Drawing(arena, moments).svg()


def save(file, svg):
    with open(file, 'w', encoding='utf-8') as out:
        out.write(svg)
