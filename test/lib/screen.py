"""What a person sees: a program at a terminal of 24 rows and 80 columns.

    screen.py STEP ... -- COMMAND ARGUMENT ...

A step is `see:TEXT`, wait until a row of the screen shows TEXT, `at:TEXT`,
wait until the row of the cursor is TEXT, or `type:TEXT`, in which \\n is the
return key. Prints the rows as they are after the last step, and fails when
something is not seen within 30 seconds.

Knows the escape sequences that line editors and typhon_output use.
"""
import os, pty, re, select, struct, sys, termios, fcntl, time

ROWS, COLUMNS, PATIENCE = 24, 80, 30


class Screen:
    def __init__(self):
        self.rows = [[' '] * COLUMNS for _ in range(ROWS)]
        self.row = self.column = 0
        self.saved = (0, 0)
        self.rest = ''

    def index(self):
        if self.row < ROWS - 1:
            self.row += 1
        else:
            del self.rows[0]
            self.rows.append([' '] * COLUMNS)

    def put(self, char):
        if self.column == COLUMNS:
            self.column = 0
            self.index()
        self.rows[self.row][self.column] = char
        self.column += 1

    def control(self, numbers, final):
        n = int(numbers) if numbers.isdigit() else 1
        if final == 'A':
            self.row = max(0, self.row - n)
        elif final == 'B':
            self.row = min(ROWS - 1, self.row + n)
        elif final == 'C':
            self.column = min(COLUMNS - 1, self.column + n)
        elif final == 'G':
            self.column = n - 1
        elif final == 'K':
            self.rows[self.row][self.column:] = [' '] * (COLUMNS - self.column)
        elif final == 'L':
            self.rows.insert(self.row, [' '] * COLUMNS)
            del self.rows[ROWS]

    def feed(self, text):
        text = self.rest + text
        at = 0
        while at < len(text):
            char = text[at]
            if char == '\x1b':
                match = re.compile(r'\x1b(?:\[([0-9;?]*)([A-Za-z])|([78DM]))'
                                   ).match(text, at)
                if not match:
                    break               # the rest is to come
                at = match.end()
                if match.group(2):
                    self.control(match.group(1), match.group(2))
                elif match.group(3) == '7':
                    self.saved = (self.row, self.column)
                elif match.group(3) == '8':
                    self.row, self.column = self.saved
                elif match.group(3) == 'D':
                    self.index()
                continue
            if char == '\r':
                self.column = 0
            elif char == '\n':
                self.index()
            elif char == '\b':
                self.column = max(0, self.column - 1)
            elif char >= ' ':
                self.put(char)
            at += 1
        self.rest = text[at:]

    def lines(self):
        return [''.join(row).rstrip() for row in self.rows]


def start(command):
    pid, fd = pty.fork()
    if pid == 0:
        os.environ['TERM'] = 'xterm'
        os.execvp(command[0], command)
    fcntl.ioctl(fd, termios.TIOCSWINSZ,
                struct.pack('HHHH', ROWS, COLUMNS, 0, 0))
    return pid, fd


def read(fd, screen, seconds):
    if select.select([fd], [], [], seconds)[0]:
        screen.feed(os.read(fd, 65536).decode('utf-8', 'replace'))


def seen(screen, kind, text):
    lines = screen.lines()
    if kind == 'at':
        return lines[screen.row] == text.rstrip()
    return any(text in line for line in lines)


def wait(fd, screen, kind, text):
    deadline = time.time() + PATIENCE
    while not seen(screen, kind, text):
        if time.time() > deadline:
            print('\n'.join(screen.lines()))
            sys.exit('not seen: ' + text)
        read(fd, screen, 0.5)


def main():
    split = sys.argv.index('--')
    pid, fd = start(sys.argv[split + 1:])
    screen = Screen()
    try:
        for step in sys.argv[1:split]:
            kind, text = step.split(':', 1)
            if kind == 'type':
                time.sleep(0.3)         # the terminal changes its mode
                os.write(fd, text.replace('\\n', '\r').encode())
            else:
                wait(fd, screen, kind, text)
        print('\n'.join(line for line in screen.lines() if line))
    finally:
        os.kill(pid, 9)
        os.close(fd)
        os.waitpid(pid, 0)


main()
