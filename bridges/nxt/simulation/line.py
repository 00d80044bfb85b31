"""The lines on which a brick is reached: pseudo-terminals and TCP.

Both carry what Bluetooth does: telegrams with two bytes of length."""

import os
import pty
import random
import socket
import time
import tty

LONGEST = 300                   # no telegram is; what claims to be is noise
LAST_WORDS = 0.1                # seconds from a cut to the end of a line
INTER_BYTE = 0.5                # seconds after which half a frame is dropped


class Framer:
    """Cuts the bytes that come in into telegrams."""

    def __init__(self):
        self.buffer = b''
        self.fed = 0.0

    def feed(self, data):
        now = time.monotonic()
        if now - self.fed > INTER_BYTE:
            self.buffer = b''           # whoever began that frame is gone
        self.fed = now
        self.buffer += data
        telegrams = []
        while len(self.buffer) >= 2:
            size = int.from_bytes(self.buffer[:2], 'little')
            if size > LONGEST:
                self.buffer = b''
            if len(self.buffer) < size + 2:
                break
            telegrams.append(self.buffer[2:size + 2])
            self.buffer = self.buffer[size + 2:]
        return telegrams


def framed(telegram):
    return len(telegram).to_bytes(2, 'little') + telegram


class Channel:
    """One open line. Writes a frame at once, as some clients expect."""

    def __init__(self, station, fd, close):
        self.station, self.fd, self.close_fd = station, fd, close
        self.framer = Framer()
        os.set_blocking(fd, False)
        station.loop.add(fd, self.ready)

    def ready(self):
        if self.fd is None:             # closed while it was waiting here
            return
        try:
            data = os.read(self.fd, 4096)
        except BlockingIOError:
            return
        except OSError:
            data = b''
        if not data:
            self.station.gone(self)
            return
        for telegram in self.framer.feed(data):
            if self.fd is not None:
                self.station.telegram(self, telegram)

    def send(self, data):
        try:
            if self.fd is not None:
                os.write(self.fd, data)
        except OSError:                 # full or gone; the reply is lost
            pass

    def close(self):
        if self.fd is not None:
            self.station.loop.remove(self.fd)
            self.fd = None
            self.close_fd()


class Station:
    """A brick and its lines, with the faults that befall them."""

    def __init__(self, loop, clock, brick, faults, seed=0):
        self.loop, self.clock = loop, clock
        self.brick, self.faults = brick, faults
        self.random = random.Random(seed)
        self.channels = []
        self.link = self.server = self.port = None
        self.wants_pty = self.wants_port = None
        self.before = lambda: None      # a world steps up to now

    def open(self, link=None, port=None):
        self.wants_pty, self.wants_port = link, port
        self.restore()

    def restore(self):
        """Opens what should be open and is not."""
        if self.wants_pty and not self.link:
            self.open_pty(self.wants_pty)
        if self.wants_port is not None and not self.server:
            self.open_server(self.wants_port)

    def open_pty(self, link):
        if os.path.lexists(link):
            if not os.path.islink(link):
                raise OSError(f'{link} is there and no symbolic link')
            os.unlink(link)
        master, slave = pty.openpty()
        tty.setraw(slave)
        os.symlink(os.ttyname(slave), link)
        self.link = link

        # The slave stays open, or the master would fail when a client goes.
        def close():
            os.close(master)
            os.close(slave)
            self.drop_link()
        self.channels.append(Channel(self, master, close))

    def drop_link(self):
        if self.link and os.path.islink(self.link):
            os.unlink(self.link)
        self.link = None

    def open_server(self, port):
        server = socket.socket()
        server.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        try:
            server.bind(('127.0.0.1', port))
            server.listen(5)
        except OSError:
            server.close()
            raise
        server.setblocking(False)
        self.server = server
        self.port = self.wants_port = server.getsockname()[1]
        self.loop.add(server, self.accept)

    def accept(self):
        try:
            client, _ = self.server.accept()
        except OSError:
            return
        client.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        self.channels.append(Channel(self, client.fileno(), client.close))

    def gone(self, channel):
        channel.close()
        self.channels.remove(channel)

    def close(self):
        self.close_server()
        for channel in self.channels:
            channel.close()
        self.channels = []

    def close_server(self):
        if self.server:
            self.loop.remove(self.server)
            self.server.close()
            self.server = None

    # ---- telegrams

    def telegram(self, channel, telegram):
        struck = self.faults.strike()
        if 'silence' in struck:
            return
        self.before()
        if 'battery' in struck:
            self.brick.set_battery(struck['battery'])
        reply = self.brick.handle(telegram, self.clock.now())
        if 'cut' in struck:
            self.cut(channel, reply, struck['cut'])
        elif reply is not None:
            self.reply(channel, reply, struck)

    def reply(self, channel, reply, struck):
        if 'refuse' in struck:
            reply = reply[:2] + bytes([struck['refuse'] & 255]) + reply[3:]
        frame = framed(reply)
        if 'garbage' in struck:
            frame = self.random.randbytes(len(frame))
        delay = struck.get('delay')
        if delay:
            self.loop.after(delay, lambda: channel.send(frame))
        else:
            channel.send(frame)

    def cut_now(self):
        self.close()

    def cut(self, channel, reply, seconds=None):
        """The line dies, in the middle of the reply if there is one."""
        if reply is not None:
            frame = framed(reply)
            channel.send(frame[:len(frame) // 2])
        self.close_server()             # no new client comes in meanwhile
        # A terminal that is closed at once loses what is in it.
        self.loop.after(LAST_WORDS, lambda: self.die(seconds))

    def die(self, seconds):
        self.close()
        if seconds is not None:
            self.loop.after(seconds, self.restore)
