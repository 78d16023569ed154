"""A node of Cyclone DDS that does what it is told, as node.py is one of rclpy: all under ROS's names, services as
rmw_cyclonedds maps them. Messages are made and read by Cyclone's own Python, not by ROS's."""

import dataclasses
import functools
import os
import sys
import threading
import time

# Before anything of Cyclone is loaded.
os.environ["CYCLONEDDS_URI"] = """<CycloneDDS><Domain>
    <General>
        <Interfaces><NetworkInterface name="lo" multicast="true"/></Interfaces>
        <AllowMulticast>true</AllowMulticast>
    </General>
</Domain></CycloneDDS>"""

from codec import cls, fill
from cyclonedds.core import Policy, Qos
from cyclonedds.domain import DomainParticipant
from cyclonedds.idl import IdlStruct, make_idl_struct, types
from cyclonedds.pub import DataWriter
from cyclonedds.sub import DataReader
from cyclonedds.topic import Topic
from cyclonedds.util import duration
from orders import obey, repeat, say
from rosidl_parser.definition import AbstractSequence, AbstractString, Array, BasicType

BASIC = {"boolean": bool, "octet": types.byte, "char": types.uint8, "float": types.float32, "double": types.float64,
         **{name: getattr(types, name) for sign in ("", "u") for bits in (8, 16, 32, 64) for name in [f"{sign}int{bits}"]}}

PLAIN = Policy.DataRepresentation(use_cdrv0_representation=True, use_xcdrv2_representation=False)

# Whose request it is, in front of each request and each reply.
Asker = make_idl_struct("Asker", "Asker", {"client": types.uint64, "number": types.int64})


def fields(ros):
    return list(zip(ros.get_fields_and_field_types(), ros.SLOT_TYPES))


def typename(name):
    package, family, short = name.split("/")
    return f"{package}.{family}.dds_.{short}_"


def kinds(name):
    # Nothing at all is a byte.
    return {field: kind_of(kind) for field, kind in fields(ros_class(name))} or {"nothing": types.uint8}


@functools.cache
def struct(name):
    """Cyclone's class for a type of ROS."""
    return make_idl_struct(name.rsplit("/")[-1], typename(name), kinds(name))


@functools.cache
def mapped(name):
    """A request or a reply with what rmw_cyclonedds has in front of it."""
    return make_idl_struct(name.rsplit("/")[-1], typename(name), {"asker": Asker, **kinds(name)})


def ros_class(name):
    kind, _, part = name.rpartition("_")
    return getattr(cls(kind), part) if part in ("Request", "Response") else cls(name)


def kind_of(kind):
    if isinstance(kind, BasicType):
        return BASIC[kind.typename]
    if isinstance(kind, AbstractString):
        return str
    if isinstance(kind, Array):
        return types.array[kind_of(kind.value_type), kind.size]
    if isinstance(kind, AbstractSequence):
        return types.sequence[kind_of(kind.value_type)]
    return struct("/".join([*kind.namespaces, kind.name]))


def filled(name, given, size=None):
    """A message of ROS; of what isn't given it has the defaults."""
    made = fill(ros_class(name)(), given)
    if size is not None:
        made.data = bytes(size)
    return made


def parts(message):
    return [value(getattr(message, field)) for field, _ in fields(message)] or [0]


def value(of):
    """As Cyclone has it."""
    if hasattr(of, "SLOT_TYPES"):
        return struct("/".join([*type(of).__module__.split(".")[:2], type(of).__name__]))(*parts(of))
    if isinstance(of, bytes):
        return of[0]
    if isinstance(of, (bool, int, float, str)):
        return of
    # Of numbers.
    return of.tolist() if hasattr(of, "tolist") else [value(item) for item in of]


def seen(of):
    return {name: part for name, part in dataclasses.asdict(of).items() if name not in ("asker", "nothing")}


def profile(said, identity=None):
    said = said or {}
    depth = Policy.History.KeepLast(said.get("depth", 10))
    reliable = Policy.Reliability.Reliable(duration(milliseconds=100))
    return Qos(
        depth,
        PLAIN,
        Policy.Reliability.BestEffort if said.get("best_effort") else reliable,
        Policy.Durability.TransientLocal if said.get("transient_local") else Policy.Durability.Volatile,
        Policy.DurabilityService(0, depth, -1, -1, -1),
        *([Policy.Userdata(identity.encode())] if identity else []))


class Peer:
    def __init__(self, name):
        self.name = name
        self.participant = DomainParticipant()
        self.kept = {}
        self.asked = 0
        self.readers, self.writers = [], []
        self.info = self.writer("ros_discovery_info", struct("rmw_dds_common/msg/ParticipantEntitiesInfo"),
                                {"transient_local": True, "depth": 1})

    def topic(self, name, kind):
        return Topic(self.participant, name, kind)

    def writer(self, name, kind, qos=None, identity=None):
        writer = DataWriter(self.participant, self.topic(name, kind), profile(qos, identity))
        self.writers.append(writer)
        return writer

    def reader(self, name, kind, take, qos=None, identity=None):
        """What comes is taken by a thread."""
        reader = DataReader(self.participant, self.topic(name, kind), profile(qos, identity))
        self.readers.append(reader)

        def run():
            for sample in reader.take_iter():
                if isinstance(sample, IdlStruct):
                    take(sample)

        threading.Thread(target=run, daemon=True).start()
        return reader

    def tell(self):
        """Which node all this belongs to."""
        gid = lambda of: {"data": list(of.guid.bytes)}
        node = {"node_namespace": "/", "node_name": self.name, "reader_gid_seq": [gid(of) for of in self.readers],
                "writer_gid_seq": [gid(of) for of in self.writers]}
        info = {"gid": gid(self.participant), "node_entities_info_seq": [node]}
        self.info.write(value(filled("rmw_dds_common/msg/ParticipantEntitiesInfo", info)))

    def publish(self, topic, type, value, qos=None, count=1, rate=100.0, size=None):
        message = struct(type)(*parts(filled(type, value, size)))
        if topic not in self.kept:
            self.kept[topic] = self.writer("rt" + topic, struct(type), qos)
        repeat(self.kept[topic].write, message, count, rate)

    def subscribe(self, topic, type, qos=None):
        self.reader("rt" + topic, struct(type), lambda sample: say(heard=topic, value=seen(sample)), qos)

    def serve(self, service, type, reply):
        kind = mapped(f"{type}_Response")
        identity = f"serviceid= {service};"
        writer = self.writer(f"rr{service}Reply", kind, identity=identity)

        def answer(request):
            say(asked=service, value=seen(request))
            writer.write(kind(request.asker, *parts(filled(f"{type}_Response", reply))))

        self.reader(f"rq{service}Request", mapped(f"{type}_Request"), answer, identity=identity)

    def call(self, service, type, value):
        kind = mapped(f"{type}_Request")
        identity = f"clientid= {service};"
        writer = self.writer(f"rq{service}Request", kind, identity=identity)
        self.asked += 1
        asker = Asker(writer.instance_handle % 2**64, self.asked)
        request = kind(asker, *parts(filled(f"{type}_Request", value)))

        def take(reply):
            if reply.asker == asker:
                say(answer=service, value=seen(reply))

        reader = self.reader(f"rr{service}Reply", mapped(f"{type}_Response"), take, identity=identity)

        def ask():
            while not (writer.matched_sub and reader.matched_pub):
                time.sleep(0.01)
            writer.write(request)

        threading.Thread(target=ask, daemon=True).start()


def main():
    peer = Peer(sys.argv[1] if len(sys.argv) > 1 else "peer")
    obey(peer, peer.tell)


main()
