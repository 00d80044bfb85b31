"""Messages of ROS 2 as JSON, and back.

As rosbridge does it: `uint8[]` and `char[]` are base64, numbers that JSON
has not are null; and a header without a stamp has the time of now.
"""

import base64
import importlib
import math

from rosidl_parser import definition as idl

from helper import Refusal

RANGES = dict([('int%d' % bits, (-2 ** (bits - 1), 2 ** (bits - 1) - 1))
               for bits in (8, 16, 32, 64)]
              + [('uint%d' % bits, (0, 2 ** bits - 1))
                 for bits in (8, 16, 32, 64)]
              + [('char', (0, 255)), ('octet', (0, 255))])


def message_class(name):
    return interface(name, 'msg')


def service_class(name):
    return interface(name, 'srv')


def action_class(name):
    return interface(name, 'action')


def interface(name, kind):
    """`pkg/kind/Name`, or as ROS 1 has it, `pkg/Name`."""
    parts = name.split('/')
    if len(parts) == 3 and parts[1] == kind:
        del parts[1]
    try:
        package, short = parts
        cls = getattr(importlib.import_module('%s.%s' % (package, kind)),
                      short)
        cls.__class__.__import_type_support__()
        return cls
    except (ValueError, ImportError, AttributeError) as problem:
        raise Refusal('no_type', '%s: %s' % (name, problem),
                      type=name) from None


# JSON to messages

def filled(cls, values, clock=None):
    message = cls()
    fill(message, values, '')
    if clock is not None and 'header' in message.get_fields_and_field_types():
        stamp(message, values, clock)
    return message


def stamp(message, values, clock):
    header = values.get('header', {})
    if hasattr(message.header, 'stamp') and 'stamp' not in header:
        message.header.stamp = clock.now().to_msg()


def fill(message, values, path):
    if values == []:                    # a message without fields
        return
    if not isinstance(values, dict):
        raise wrong(path.rstrip('.') or 'message', type(message).__name__,
                    values)
    types = message.get_fields_and_field_types()
    slots = dict(zip(types, message.SLOT_TYPES))
    for name, value in values.items():
        if name not in types:
            raise Refusal('no_field', '%s%s is not of %s'
                          % (path, name, type(message).__name__),
                          field=path + name)
        if value is None:               # nothing is said of it
            continue
        set_field(message, name, value, path + name, types[name], slots[name])


def set_field(message, name, value, path, type_name, slot):
    try:
        setattr(message, name, converted(value, path, type_name, slot))
    except (AssertionError, ValueError, TypeError, OverflowError):
        raise wrong(path, type_name, value) from None


def wrong(path, type_name, value):
    shown = value if isinstance(value, (int, float, str)) else repr(value)
    return Refusal('wrong_value', '%s is %s, not %.100r'
                   % (path, type_name, value),
                   field=path, type=type_name, value=shown)


def converted(value, path, type_name, slot):
    if isinstance(slot, idl.NamespacedType):
        inner = getattr(importlib.import_module('.'.join(slot.namespaces)),
                        slot.name)()
        fill(inner, value, path + '.')
        return inner
    if isinstance(slot, idl.AbstractNestedType):
        return elements(value, path, type_name, slot)
    good = basic(value, slot)
    if good is None:
        raise wrong(path, type_name, value)
    return good


def elements(value, path, type_name, slot):
    if is_bytes(slot) and isinstance(value, str):
        value = list(base64.b64decode(value, validate=True))
    if not isinstance(value, list):
        raise wrong(path, type_name, value)
    return [converted(one, '%s[%d]' % (path, number), type_name,
                      slot.value_type)
            for number, one in enumerate(value)]


def is_bytes(slot):
    return isinstance(slot.value_type, idl.BasicType) \
        and slot.value_type.typename in ('uint8', 'char')


def basic(value, slot):
    """The value as the field wants it, or None."""
    if isinstance(slot, idl.AbstractGenericString):
        return value if isinstance(value, str) else None
    name = slot.typename
    if name == 'boolean':
        return value if isinstance(value, bool) else None
    if isinstance(value, bool) or not isinstance(value, (int, float)):
        return None
    if name in ('float', 'double', 'long double'):
        return float(value)
    least, most = RANGES[name]
    if not isinstance(value, int) or not least <= value <= most:
        return None
    return bytes([value]) if name == 'octet' else value


# Messages to JSON

def said(message):
    types = message.get_fields_and_field_types()
    return {name: said_value(getattr(message, name), slot)
            for name, slot in zip(types, message.SLOT_TYPES)}


def said_value(value, slot):
    if isinstance(slot, idl.NamespacedType):
        return said(value)
    if isinstance(slot, idl.AbstractNestedType):
        if is_bytes(slot):
            return base64.b64encode(bytes(value)).decode()
        if hasattr(value, 'tolist'):
            value = value.tolist()
        return [said_value(one, slot.value_type) for one in value]
    if isinstance(value, bytes):
        return value[0]
    if isinstance(value, float) and not math.isfinite(value):
        return None
    return value
