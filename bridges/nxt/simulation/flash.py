"""The files of a brick and the handles by which they are read and written."""

from fnmatch import fnmatchcase

NO_HANDLES, NO_SPACE, EOF = 0x81, 0x82, 0x85
NOT_FOUND, CLOSED, NO_LINEAR_SPACE = 0x87, 0x88, 0x89
BUSY, NO_APPEND, FULL, EXISTS = 0x8B, 0x8D, 0x8E, 0x8F
BAD_NAME, BAD_HANDLE = 0x92, 0x93
HANDLES, CAPACITY = 16, 60000

FACTORY = {'! Attention.rso': 700, '! Click.rso': 150, '! Startup.rso': 1200,
           'Demo.rxe': 1234}


class Refused(Exception):
    def __init__(self, status):
        super().__init__(status)
        self.status = status


class File:
    def __init__(self, content=b'', limit=0, data=False):
        self.content = bytearray(content)
        self.size_limit = limit or len(content)
        self.data = data                # may be appended to

    def size(self):
        return len(self.content) if self.data else self.size_limit


class Handle:
    def __init__(self, use, name, file=None, names=()):
        self.use, self.name, self.file = use, name, file
        self.names = list(names)
        self.position = 0


class Flash:
    def __init__(self, modules=()):
        self.files = {name: File(bytes(i % 251 for i in range(size)))
                      for name, size in FACTORY.items()}
        self.handles = {}
        self.modules = list(modules)

    def free(self):
        used = sum(f.size_limit for n, f in self.files.items() if n not in FACTORY)
        return CAPACITY - used

    # ---- handles

    def open(self, handle):
        for number in range(HANDLES):
            if number not in self.handles:
                self.handles[number] = handle
                return number
        raise Refused(NO_HANDLES)

    def handle(self, number, *uses):
        if number not in self.handles:
            raise Refused(CLOSED)
        if self.handles[number].use not in uses:
            raise Refused(BAD_HANDLE)
        return self.handles[number]

    def close(self, number):
        if self.handles.pop(number, None) is None:
            raise Refused(CLOSED)

    def being(self, name, *uses):
        return any(h.name == name and h.use in uses
                   for h in self.handles.values())

    # ---- files

    def known(self, name):
        if name not in self.files:
            raise Refused(NOT_FOUND)
        return self.files[name]

    def open_read(self, name):
        file = self.known(name)
        if self.being(name, 'write'):
            raise Refused(BUSY)
        return self.open(Handle('read', name, file)), file.size()

    def open_write(self, name, size, data=False, full=NO_SPACE):
        if not name:
            raise Refused(BAD_NAME)
        if name in self.files:
            raise Refused(EXISTS)
        if size > self.free():
            raise Refused(full)
        file = File(limit=size, data=data)
        number = self.open(Handle('write', name, file))
        self.files[name] = file
        return number

    def open_append(self, name):
        file = self.known(name)
        if self.being(name, 'write', 'read'):
            raise Refused(BUSY)
        left = file.size_limit - len(file.content)
        if not file.data or not left:
            raise Refused(NO_APPEND)
        return self.open(Handle('write', name, file)), left

    def read(self, number, count):
        """The bytes, padded, and whether there were so many."""
        handle = self.handle(number, 'read')
        begin = handle.position
        data = bytes(handle.file.content[begin:begin + count])
        handle.position += len(data)
        return data.ljust(count, b'\0'), len(data) == count

    def write(self, number, data):
        """How many bytes were written, and whether all."""
        file = self.handle(number, 'write').file
        left = file.size_limit - len(file.content)
        file.content += data[:left]
        return min(left, len(data)), left >= len(data)

    def delete(self, name):
        self.known(name)
        if self.being(name, 'read', 'write'):
            raise Refused(BUSY)
        del self.files[name]

    def erase(self):
        self.files.clear()
        self.handles.clear()

    # ---- searches

    def find_first(self, pattern):
        names = [n for n in self.files if fnmatchcase(n, pattern)]
        return self.begin_search('find', pattern, names)

    def find_first_module(self, pattern):
        names = [m for m in self.modules if fnmatchcase(m, pattern)]
        return self.begin_search('module', pattern, names)

    def begin_search(self, use, pattern, names):
        if not names:
            raise Refused(NOT_FOUND if use == 'find' else 0x90)
        number = self.open(Handle(use, pattern, names=names))
        return number, self.find_next(number, use)

    def find_next(self, number, use='find'):
        """The next name; files deleted meanwhile are passed over."""
        names = self.handle(number, use).names
        while names:
            name = names.pop(0)
            if use == 'module' or name in self.files:
                return name
        raise Refused(NOT_FOUND if use == 'find' else 0x90)
