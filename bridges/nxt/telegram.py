"""Telegrams of the NXT (LEGO protocol 1.124): bytes to values and back.

A telegram is a type byte, an opcode and a payload.  On a serial line its
length goes before it, two bytes, little endian.  All that is known about
the commands is the table below; the rest of the file reads the table.

Nothing here does input or output, or looks at a clock.

Values are in dicts by field name: int, bool, str for names, bytes for
data.
"""

import struct
from collections import namedtuple

DIRECT, SYSTEM, REPLY, NO_REPLY = 0x00, 0x01, 0x02, 0x80

STATUS = {
    0x00: 'success', 0x20: 'pending', 0x40: 'mailbox_empty',
    0x81: 'no_more_handles', 0x82: 'no_space', 0x83: 'no_more_files',
    0x84: 'end_of_file_expected', 0x85: 'end_of_file',
    0x86: 'not_a_linear_file', 0x87: 'file_not_found',
    0x88: 'handle_closed', 0x89: 'no_linear_space', 0x8A: 'undefined',
    0x8B: 'file_busy', 0x8C: 'no_write_buffers', 0x8D: 'cannot_append',
    0x8E: 'file_full', 0x8F: 'file_exists', 0x90: 'module_not_found',
    0x91: 'out_of_bounds', 0x92: 'illegal_file_name',
    0x93: 'illegal_handle', 0xBD: 'request_failed',
    0xBE: 'unknown_opcode', 0xBF: 'insane_packet', 0xC0: 'out_of_range',
    0xDD: 'bus_error', 0xDE: 'no_memory_in_buffer',
    0xDF: 'channel_invalid', 0xE0: 'channel_not_configured',
    0xEC: 'no_active_program', 0xED: 'illegal_size',
    0xEE: 'illegal_mailbox', 0xEF: 'bad_field', 0xF0: 'bad_port',
    0xFB: 'out_of_memory', 0xFF: 'bad_arguments',
}


def status_name(code):
    """The name of a status byte, which may be one that LEGO never defined."""
    return STATUS.get(code, 'status_%d' % code)


class BadTelegram(ValueError):
    """Bytes that are no telegram, or values that fit into none."""


# A field is (name, kind).  Kinds:
#   B b H h I i  integers as in struct, little endian
#   ?            boolean: any byte but 0 is true, 1 is sent
#   zN           name, padded with zeros to N bytes, NUL included
#   xN           so many bytes of data
#   #B, #H       number of bytes in the field called `data`
#   *            that data; *N: padded with zeros to N bytes
#   m, mN        message: size with its NUL, text, NUL; padded to N bytes

Command = namedtuple('Command',
                     'name kind opcode reply_wanted request reply')

_NAME = 'name:z20'
_STATE = ('port:B power:b mode:B regulation:B turn_ratio:b run_state:B '
          'limit:I')
_MODULE = 'handle:B name:z20 id:I size:I iomap_size:H'
_FILE = 'handle:B name:z20 size:I'

# Opcode, name, request, reply.  `!`: no reply is asked for, unless said.
_DIRECT = (
    (0x00, 'STARTPROGRAM', _NAME, ''),
    (0x01, 'STOPPROGRAM', '', ''),
    (0x02, 'PLAYSOUNDFILE!', 'loop:? ' + _NAME, ''),
    (0x03, 'PLAYTONE!', 'frequency:H duration:H', ''),
    (0x04, 'SETOUTPUTSTATE!', _STATE, ''),
    (0x05, 'SETINPUTMODE!', 'port:B type:B mode:B', ''),
    (0x06, 'GETOUTPUTSTATE', 'port:B',
     _STATE + ' tacho:i block:i rotation:i'),
    (0x07, 'GETINPUTVALUES', 'port:B',
     'port:B valid:? calibrated:? type:B mode:B raw:H normalized:H '
     'scaled:h calibrated_value:h'),
    (0x08, 'RESETINPUTSCALEDVALUE', 'port:B', ''),
    (0x09, 'MESSAGEWRITE', 'inbox:B message:m', ''),
    (0x0A, 'RESETMOTORPOSITION', 'port:B relative:?', ''),
    (0x0B, 'GETBATTERYLEVEL', '', 'millivolts:H'),
    (0x0C, 'STOPSOUNDPLAYBACK', '', ''),
    (0x0D, 'KEEPALIVE', '', 'sleep_time:I'),
    (0x0E, 'LSGETSTATUS', 'port:B', 'ready:B'),
    (0x0F, 'LSWRITE', 'port:B tx:#B rx:B data:*', ''),
    (0x10, 'LSREAD', 'port:B', 'n:#B data:*16'),
    (0x11, 'GETCURRENTPROGRAMNAME', '', _NAME),
    (0x13, 'MESSAGEREAD', 'remote:B local:B remove:?',
     'local:B message:m59'),
)
_SYSTEM = (
    (0x80, 'OPENREAD', _NAME, 'handle:B size:I'),
    (0x81, 'OPENWRITE', _NAME + ' size:I', 'handle:B'),
    (0x82, 'READ', 'handle:B size:H', 'handle:B n:#H data:*'),
    (0x83, 'WRITE', 'handle:B data:*', 'handle:B size:H'),
    (0x84, 'CLOSE', 'handle:B', 'handle:B'),
    (0x85, 'DELETE', _NAME, _NAME),
    (0x86, 'FINDFIRST', 'pattern:z20', _FILE),
    (0x87, 'FINDNEXT', 'handle:B', _FILE),
    (0x88, 'GETFIRMWAREVERSION', '',
     'protocol_minor:B protocol_major:B firmware_minor:B '
     'firmware_major:B'),
    (0x89, 'OPENWRITELINEAR', _NAME + ' size:I', 'handle:B'),
    (0x8B, 'OPENWRITEDATA', _NAME + ' size:I', 'handle:B'),
    (0x8C, 'OPENAPPENDDATA', _NAME, 'handle:B size:I'),
    (0x90, 'REQUESTFIRSTMODULE', 'pattern:z20', _MODULE),
    (0x91, 'REQUESTNEXTMODULE', 'handle:B', _MODULE),
    (0x92, 'CLOSEMODULEHANDLE', 'handle:B', 'handle:B'),
    (0x94, 'READIOMAP', 'id:I offset:H size:H', 'id:I n:#H data:*'),
    (0x95, 'WRITEIOMAP', 'id:I offset:H n:#H data:*', 'id:I size:H'),
    (0x97, 'BOOT', 'magic:z19', 'answer:z4'),
    (0x98, 'SETBRICKNAME', 'name:z15', ''),
    (0x9B, 'GETDEVICEINFO', '',
     'name:z15 address:x6 zero:B signal:x4 free_flash:I'),
    (0xA0, 'DELETEUSERFLASH', '', ''),
    (0xA1, 'POLLCOMMANDLENGTH', 'buffer:B', 'buffer:B size:B'),
    (0xA2, 'POLLCOMMAND', 'buffer:B size:B', 'buffer:B n:#B data:*'),
    (0xA4, 'BLUETOOTHFACTORYRESET', '', ''),
)


def _fields(text):
    return tuple(tuple(field.split(':')) for field in text.split())


def _commands():
    for kind, rows in ((DIRECT, _DIRECT), (SYSTEM, _SYSTEM)):
        for opcode, name, request, reply in rows:
            yield Command(name.rstrip('!'), kind, opcode,
                          not name.endswith('!'),
                          _fields(request), _fields(reply))


COMMANDS = {command.name: command for command in _commands()}
BY_OPCODE = {(command.kind, command.opcode): command
             for command in COMMANDS.values()}


def command_of(name):
    try:
        return COMMANDS[name]
    except (KeyError, TypeError):
        raise BadTelegram('no command %r' % (name,)) from None


# Fields to bytes

def _pad(data, length, name):
    if len(data) > length:
        raise BadTelegram('%s: more than %d bytes' % (name, length))
    return data + bytes(length - len(data))


def _encode_name(value, size, name):
    try:
        data = value.encode('ascii')
    except (AttributeError, UnicodeEncodeError):
        raise BadTelegram('%s: not an ASCII text' % name) from None
    if 0 in data:
        raise BadTelegram('%s: NUL in a text' % name)
    # A brick's name fills its 15 bytes, and has its NUL after them.
    longest = 15 if size == 15 else size - 1
    if len(data) > longest:
        raise BadTelegram('%s: more than %d characters' % (name, longest))
    return _pad(data, max(size, len(data) + 1), name)


def _bytes(value, name):
    if not isinstance(value, (bytes, bytearray)):
        raise BadTelegram('%s: not bytes' % name)
    return bytes(value)


def _encode_message(value, size, name):
    if value is None and size:          # an empty box
        return bytes(1 + size)
    data = _bytes(value or b'', name) + b'\0'
    if len(data) > 59:
        raise BadTelegram('%s: more than 58 bytes' % name)
    return bytes([len(data)]) + _pad(data, size or len(data), name)


def _encode_field(name, kind, values):
    value = values.get(name)
    if kind[0] == 'z':
        return _encode_name('' if value is None else value,
                            int(kind[1:]), name)
    if kind[0] == 'x':
        return _pad(_bytes(value or b'', name), int(kind[1:]), name)
    if kind[0] == 'm':
        return _encode_message(value, int(kind[1:] or 0), name)
    if kind[0] == '*':
        data = _bytes(values.get('data') or b'', 'data')
        return _pad(data, int(kind[1:] or len(data)), name)
    if kind == '?':
        return b'\1' if value else b'\0'
    if kind[0] == '#':
        value, kind = len(values.get('data') or b''), kind[1:]
    try:
        return struct.pack('<' + kind, 0 if value is None else value)
    except struct.error as problem:
        raise BadTelegram('%s: %s' % (name, problem)) from None


def _encode(fields, values):
    return b''.join(_encode_field(name, kind, values)
                    for name, kind in fields)


# Bytes to fields

def _text(data):
    return bytes(data).split(b'\0', 1)[0].decode('latin-1')


def _decode_message(data, name):
    if not data or data[0] > len(data) - 1:
        raise BadTelegram('%s: wrong size' % name)
    text = bytes(data[1:1 + data[0]])
    return text[:-1] if text.endswith(b'\0') else text


def _decode(fields, data):
    values, at, counted = {}, 0, None
    for name, kind in fields:
        rest = data[at:]
        if kind[0] == 'z':
            values[name] = _text(rest[:int(kind[1:])])
            at += int(kind[1:])
        elif kind[0] == 'x':
            values[name] = bytes(rest[:int(kind[1:])])
            at += int(kind[1:])
        elif kind[0] == 'm':
            values[name] = _decode_message(rest, name)
            at = len(data)
        elif kind[0] == '*':
            if counted is not None and counted > len(rest):
                raise BadTelegram('%d bytes said, %d there'
                                  % (counted, len(rest)))
            values[name] = bytes(rest[:counted])
            at = len(data)
        else:
            code = '<' + kind.lstrip('#')
            size = struct.calcsize(code)
            if len(rest) < size:
                raise BadTelegram('%s is missing' % name)
            value = struct.unpack(code, bytes(rest[:size]))[0]
            if kind[0] == '#':
                counted = value
            else:
                values[name] = value
            at += size
    return values


# Telegrams

def encode_request(name, values=None, reply=None):
    """The telegram of a command; missing values are zero.

    `reply` says whether the brick shall answer; None: as is usual.
    """
    command = command_of(name)
    if reply is None:
        reply = command.reply_wanted
    values = dict(values or {})
    if name == 'BOOT':
        values['magic'] = "Let's dance: SAMBA"
    unknown = set(values) - {field for field, _ in command.request}
    if unknown:
        raise BadTelegram('%s has no %s' % (name, ', '.join(sorted(unknown))))
    kind = command.kind | (0 if reply else NO_REPLY)
    return bytes([kind, command.opcode]) + _encode(command.request, values)


def decode_request(telegram):
    """(name, values, whether a reply is wanted) of a request.

    Names may be shorter than their fields: some clients do not pad them.
    """
    if len(telegram) < 2:
        raise BadTelegram('shorter than two bytes')
    key = (telegram[0] & ~NO_REPLY, telegram[1])
    if key not in BY_OPCODE:
        raise BadTelegram('no command %02x %02x' % key)
    command = BY_OPCODE[key]
    if command.name == 'SETBRICKNAME':
        values = {'name': _text(telegram[2:17])}
    else:
        values = _decode(command.request, telegram[2:])
    return command.name, values, not telegram[0] & NO_REPLY


def encode_reply(name, status, values=None):
    """The reply to a command; missing values are zero."""
    command = command_of(name)
    head = bytes([REPLY, command.opcode, status])
    return head + _encode(command.reply, values or {})


def decode_reply(name, telegram):
    """(status, values) of a reply; no values unless the status is 0."""
    command = command_of(name)
    if len(telegram) < 3 or telegram[0] != REPLY:
        raise BadTelegram('no reply: %s' % bytes(telegram[:8]).hex())
    if telegram[1] != command.opcode:
        raise BadTelegram('reply to opcode %02x' % telegram[1])
    if telegram[2] != 0:
        return telegram[2], {}
    return 0, _decode(command.reply, telegram[3:])


# Frames

def frame(telegram):
    """The telegram with its length before it."""
    return struct.pack('<H', len(telegram)) + telegram


def unframe(buffer):
    """Take one whole telegram off the front of a bytearray, or None."""
    if len(buffer) < 2:
        return None
    end = 2 + buffer[0] + 256 * buffer[1]
    if len(buffer) < end:
        return None
    telegram = bytes(buffer[2:end])
    del buffer[:end]
    return telegram
