"""The far end of a pseudo-terminal, which answers what a test says.

The first line it prints is the name of the terminal.  Every telegram that
comes is printed in hexadecimal digits.  Lines on the standard input say
what happens at the next telegrams, one line for each:

    answer HEX      a reply, with its length before it
    late SECONDS HEX
    raw HEX         these bytes
    silence
    lose HEX        these bytes, and the line is gone

and at once:

    now HEX         a reply
    lock            the terminal is another's; says `locked`
    forbid          it may not be opened; says `forbidden`

KEEPALIVE always has its reply, and the question for the firmware if
nothing else is said; they are not reported.  Others have none without a line.
A telegram that comes before the one before it has had its reply is reported as
`overlap`.
"""

import fcntl
import os
import pty
import select
import sys
import time
import tty


def say(text):
    print(text, flush=True)


class Peer:
    def __init__(self):
        self.master, self.slave = pty.openpty()
        tty.setraw(self.slave)
        self.script, self.buffer, self.commands = [], b'', b''
        self.late = None                # (time, bytes)

    def listen(self, wait):
        ready = select.select([sys.stdin.fileno()], [], [], wait)[0]
        if not ready:
            return
        data = os.read(sys.stdin.fileno(), 65536)
        if not data:
            sys.exit(0)
        self.commands += data
        *lines, self.commands = self.commands.split(b'\n')
        for line in lines:
            words = line.decode().split()
            if words == ['lock']:
                fcntl.flock(self.slave, fcntl.LOCK_EX | fcntl.LOCK_NB)
                say('locked')
            elif words == ['forbid']:
                os.chmod(os.ttyname(self.slave), 0)
                say('forbidden')
            elif words[:1] == ['now']:
                self.send(bytes.fromhex(words[1]))
            elif words:
                self.script.append(words)

    def send(self, telegram):
        os.write(self.master,
                 len(telegram).to_bytes(2, 'little') + telegram)

    def act(self, telegram):
        if telegram == b'\x00\x0d':
            self.send(bytes.fromhex('020d00c0270900'))
            return
        if telegram == b'\x01\x88' and not self.script:
            self.send(bytes.fromhex('0288007c011d01'))
            return
        say(telegram.hex())
        if not self.script:
            return
        what, *words = self.script.pop(0)
        data = bytes.fromhex(words[-1]) if words else b''
        if what == 'answer':
            self.send(data)
        elif what == 'late':
            self.late = (time.monotonic() + float(words[0]), data)
        elif what in ('raw', 'lose'):
            os.write(self.master, data)
        if what == 'lose':
            time.sleep(0.2)
            os.close(self.slave)
            os.close(self.master)
            sys.exit(0)

    def telegrams(self):
        while len(self.buffer) >= 2:
            end = 2 + self.buffer[0] + 256 * self.buffer[1]
            if len(self.buffer) < end:
                return
            telegram, self.buffer = self.buffer[2:end], self.buffer[end:]
            if self.late:
                say('overlap')
            self.listen(0)              # what was said before it came
            self.act(telegram)

    def run(self):
        say(os.ttyname(self.slave))
        while True:
            wait = None
            if self.late:
                wait = max(0, self.late[0] - time.monotonic())
            ready = select.select([sys.stdin.fileno(), self.master],
                                  [], [], wait)[0]
            if self.late and time.monotonic() >= self.late[0]:
                late, self.late = self.late, None
                self.send(late[1])
            if sys.stdin.fileno() in ready:
                self.listen(0)
            if self.master in ready:
                self.buffer += os.read(self.master, 4096)
                self.telegrams()


Peer().run()
