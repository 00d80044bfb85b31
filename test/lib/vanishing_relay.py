"""Stands before a server whose machine can vanish.

    python3 test/lib/vanishing_relay.py SOCKET

Listens at a port of the loopback interface, which it prints, and carries
bytes between clients there and the server at the Unix socket SOCKET.
Each line of its standard input is carried out and answered with `done`:

    vanish   no packet is taken any more, none is acknowledged; what the
             server has heard ends
    break    clients find their connections closed, the server does not
    return   new connections are accepted again; the server finds those closed

Ends with its standard input. A stopped process would not do: the kernel
acknowledges in its place."""

import contextlib
import ctypes
import selectors
import socket
import struct
import sys

ATTACH_FILTER, DETACH_FILTER = 26, 27       # of SOL_SOCKET, on Linux


def deafen(sock):
    """The kernel drops each packet for sock before TCP sees it."""
    nothing = ctypes.create_string_buffer(struct.pack('HBBI', 0x06, 0, 0, 0))
    program = struct.pack('HL', 1, ctypes.addressof(nothing))
    sock.setsockopt(socket.SOL_SOCKET, ATTACH_FILTER, program)


class Relay:
    def __init__(self, server):
        self.server = server
        self.other = {}                     # of each socket, the other end
        self.deaf = []                      # kept open: a closed one would
                                            # be answered for
        self.broken = []                    # ends of the server
        self.door = socket.create_server(('127.0.0.1', 0))
        self.select = selectors.DefaultSelector()
        self.select.register(self.door, selectors.EVENT_READ, self.enter)
        self.select.register(sys.stdin, selectors.EVENT_READ, self.order)
        print(self.door.getsockname()[1], flush=True)

    def run(self):
        while True:
            for key, _ in self.select.select()[:1]:     # others may be gone
                key.data(key.fileobj)                   # when that is done

    def enter(self, door):
        client, _ = door.accept()
        server = socket.socket(socket.AF_UNIX)
        server.connect(self.server)
        for one, other in ((client, server), (server, client)):
            self.other[one] = other
            self.select.register(one, selectors.EVENT_READ, self.carry)

    def carry(self, source):
        try:
            data = source.recv(65536)
            self.other[source].sendall(data)
        except OSError:
            data = b''
        if not data:
            for sock in (source, self.other.pop(source)):
                self.other.pop(sock, None)
                self.forget(sock).close()

    def forget(self, sock):
        self.select.unregister(sock)
        return sock

    def order(self, stdin):
        line = stdin.readline()
        if not line:
            sys.exit()
        {'vanish': self.vanish, 'break': self.breaks,
         'return': self.be_back}[line.strip()]()
        print('done', flush=True)

    def vanish(self):
        deafen(self.door)
        for sock in list(self.other):
            self.forget(sock)
            if sock.family == socket.AF_UNIX:
                sock.close()
            else:
                deafen(sock)
                self.deaf.append(sock)
        self.other.clear()

    def breaks(self):
        for sock in list(self.other):
            self.forget(sock)
            if sock.family == socket.AF_UNIX:
                self.broken.append(sock)
            else:
                sock.close()
        self.other.clear()

    def be_back(self):
        for sock in self.broken:
            sock.close()
        self.broken.clear()
        with contextlib.suppress(OSError):          # it has no filter
            self.door.setsockopt(socket.SOL_SOCKET, DETACH_FILTER, 0)


Relay(sys.argv[1]).run()
