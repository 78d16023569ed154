"""Messages as rclpy serialises them and what is in them, one JSON object a line.

codec.py make SEED    every type of the common interfaces, with its defaults and with random contents
codec.py read         those that come in, in the same form
"""

import base64
import importlib
import json
import math
import random
import sys

import numpy
from rclpy.serialization import deserialize_message, serialize_message
from rosidl_parser.definition import (AbstractNestedType, AbstractString, AbstractWString, Array, BasicType,
                                      BoundedSequence, BoundedString, BoundedWString, NamespacedType)

PACKAGES = """action_msgs actionlib_msgs builtin_interfaces diagnostic_msgs geometry_msgs lifecycle_msgs nav_msgs
rcl_interfaces rosgraph_msgs sensor_msgs shape_msgs std_msgs std_srvs stereo_msgs test_msgs trajectory_msgs
type_description_interfaces unique_identifier_msgs visualization_msgs""".split()

INTEGERS = {f"{sign}int{bits}": (0 if sign else -(2 ** (bits - 1)), 2 ** (bits - (0 if sign else 1)) - 1)
            for sign in ("", "u") for bits in (8, 16, 32, 64)}
BYTES = ("uint8", "octet", "char")

chance = random.Random()


def scalar(name):
    if name == "boolean":
        return chance.random() < 0.5
    if name in INTEGERS:
        return chance.choice([chance.randint(*INTEGERS[name]), *INTEGERS[name], 0])
    if name == "octet":
        return bytes([chance.randrange(256)])
    if name == "char":
        return chance.randrange(256)
    value = chance.choice([chance.uniform(-1e6, 1e6), math.nan, math.inf, -math.inf, 0.0, -0.0, 1e-300])
    return float(numpy.float32(value)) if name == "float" else value


def text(kind):
    alphabet = "aZ0 #\"'\\\n\täß水" + ("" if isinstance(kind, AbstractWString) else "🤖")
    longest = kind.maximum_size if isinstance(kind, (BoundedString, BoundedWString)) else 30
    value = "".join(chance.choice(alphabet) for _ in range(chance.randrange(longest + 1)))
    return value.encode()[:longest].decode(errors="ignore") if isinstance(kind, BoundedString) else value


def class_of(kind):
    assert isinstance(kind, NamespacedType), kind
    module = importlib.import_module(".".join(kind.namespaces))
    if hasattr(module, kind.name):
        return getattr(module, kind.name)
    action, part = kind.name.rsplit("_", 1)
    return getattr(getattr(module, action), part)


def cls(name):
    package, family, short = name.split("/")
    return class_of(NamespacedType([package, family], short))


def fill(message, fields):
    kinds = dict(zip(message.get_fields_and_field_types(), message.SLOT_TYPES))
    for name, value in fields.items():
        kind = kinds[name]
        if isinstance(kind, NamespacedType):
            fill(getattr(message, name), value)
        elif isinstance(kind, AbstractNestedType) and isinstance(kind.value_type, NamespacedType):
            setattr(message, name, [fill(class_of(kind.value_type)(), item) for item in value])
        elif isinstance(kind, BasicType) and kind.typename == "octet":
            setattr(message, name, bytes([value]))
        else:
            setattr(message, name, value)
    return message


def value_of(kind):
    """Anything that a field can hold."""
    if isinstance(kind, BasicType):
        return scalar(kind.typename)
    if isinstance(kind, AbstractString | AbstractWString):
        return text(kind)
    if not isinstance(kind, AbstractNestedType):
        return message(class_of(kind))
    if isinstance(kind, Array):
        count = kind.size
    else:
        count = chance.randrange(min(kind.maximum_size, 6) + 1 if isinstance(kind, BoundedSequence) else 6)
    return [value_of(kind.value_type) for _ in range(count)]


def message(cls):
    made = cls()
    for name, kind in zip(cls.get_fields_and_field_types(), cls.SLOT_TYPES):
        setattr(made, name, value_of(kind))
    return made


def seen(value, kind):
    """A value as lrp sees it."""
    if isinstance(kind, NamespacedType):
        fields = zip(value.get_fields_and_field_types(), value.SLOT_TYPES)
        return {name: seen(getattr(value, name), inner) for name, inner in fields}
    if isinstance(kind, AbstractNestedType):
        if isinstance(kind.value_type, BasicType) and kind.value_type.typename in BYTES:
            raw = b"".join(item if isinstance(item, bytes) else bytes([item]) for item in value)
            return {"lua": "bytes", "base64": base64.b64encode(raw).decode()}
        return [seen(item, kind.value_type) for item in value]
    if isinstance(kind, AbstractString | AbstractWString):
        return value
    if kind.typename == "octet":
        return value[0]
    if kind.typename in INTEGERS or kind.typename == "char":
        return int(value)
    if kind.typename == "boolean":
        return bool(value)
    value = float(value)
    if math.isfinite(value):
        return value
    return {"lua": "nan" if math.isnan(value) else "inf" if value > 0 else "-inf"}


def tell(full, cls, serialized):
    value = seen(deserialize_message(serialized, cls), NamespacedType(["", ""], ""))
    print(json.dumps({"type": full, "bytes": serialized.hex(), "value": value}))


def classes():
    for package in PACKAGES:
        for family, parts in (("msg", None), ("srv", ("Request", "Response")), ("action", ("Goal", "Result", "Feedback"))):
            try:
                module = importlib.import_module(f"{package}.{family}")
            except ModuleNotFoundError:
                continue
            for name in sorted(vars(module)):
                cls = getattr(module, name)
                if not isinstance(cls, type):
                    continue
                full = f"{package}/{family}/{name}"
                if parts is None:
                    yield full, cls
                    continue
                if not hasattr(cls, parts[0]):
                    continue
                for part in parts:
                    yield f"{full}_{part}", getattr(cls, part)
                if family == "action":
                    yield f"{full}_SendGoal_Request", cls.Impl.SendGoalService.Request
                    yield f"{full}_SendGoal_Response", cls.Impl.SendGoalService.Response
                    yield f"{full}_GetResult_Request", cls.Impl.GetResultService.Request
                    yield f"{full}_GetResult_Response", cls.Impl.GetResultService.Response
                    yield f"{full}_FeedbackMessage", cls.Impl.FeedbackMessage


if __name__ == "__main__":
    if sys.argv[1] == "make":
        chance.seed(int(sys.argv[2]))
        for full, cls in classes():
            for turn in range(5):
                tell(full, cls, serialize_message(message(cls) if turn else cls()))
    else:
        known = dict(classes())
        for line in sys.stdin:
            said = json.loads(line)
            tell(said["type"], known[said["type"]], bytes.fromhex(said["bytes"]))
