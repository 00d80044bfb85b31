"""A terminal in which a Prolog top level runs.

    terminal.py COLUMNS COMMAND ARGUMENT ...

Types each line of the standard input when the top level has prompted for it:
the first at the first prompt, the others at the first prompt after a text
@@...@@. Writes what the terminal shows, line by line, without escape
sequences. Ends when the top level has ended."""

import codecs
import fcntl
import os
import pty
import re
import select
import struct
import sys
import termios

ESCAPE = re.compile(r'\x1b\[[0-9;?]*[A-Za-z]|\x1b[=>78]|[\r\a]')
PROMPTED = re.compile(r'@@(?s:.*)\?- ')


def start(columns, command):
    pid, fd = pty.fork()
    if pid == 0:
        fcntl.ioctl(0, termios.TIOCSWINSZ,
                    struct.pack('HHHH', 24, columns, 0, 0))
        os.environ['TERM'] = 'xterm'
        os.execvp(command[0], command)
    return pid, fd


class Reader:
    """The lines that can be read from a file descriptor."""

    def __init__(self, fd):
        self.fd = fd
        self.decoder = codecs.getincrementaldecoder('utf-8')('replace')
        self.begun = ''

    def read(self):
        data = os.read(self.fd, 65536)
        text = self.decoder.decode(data)
        *lines, self.begun = (self.begun + text).split('\n')
        return data, text, lines


def relay(fd):
    typed, shown = Reader(0), Reader(fd)
    sources, waiting, since = [fd, 0], [], '@@'
    while True:
        ready = select.select(sources, [], [])[0]
        if 0 in ready:
            data, _, lines = typed.read()
            waiting += lines
            if not data:
                sources = [fd]
        if fd in ready:
            data, text, lines = shown.read()
            if not data:
                return
            since += text
            for line in lines:
                print(ESCAPE.sub('', line), flush=True)
        if waiting and PROMPTED.search(ESCAPE.sub('', since)):
            since = ''
            os.write(fd, waiting.pop(0).encode() + b'\r')


def main():
    pid, fd = start(int(sys.argv[1]), sys.argv[2:])
    try:
        relay(fd)
    except OSError:             # the top level has ended
        pass
    os.close(fd)
    os.waitpid(pid, 0)


main()
