"""Makes a package of ROS 2 definitions, PACKAGE/{msg,srv,action}, one of the Python that runs this, for its rclpy.

The wheels bring rosidl's generators, headers and libraries; what takes their place in a build is here. All that is
generated becomes one library: with a single type support rosidl calls that directly, so none has to be found at run time.
"""

import contextlib
import importlib
import io
import logging
import os
import shutil
import subprocess
import sys
import sysconfig
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy

# Where rosidl looks for its templates.
os.environ["AMENT_PREFIX_PATH"] = sys.prefix

from rosidl_adapter.action import convert_action_to_idl
from rosidl_adapter.msg import convert_msg_to_idl
from rosidl_adapter.srv import convert_srv_to_idl
from rosidl_generator_c.cli import GenerateC
from rosidl_generator_py.cli import GeneratePython
from rosidl_typesupport_c.cli import GenerateCTypesupport
from rosidl_typesupport_fastrtps_c.cli import GenerateFastRTPSCTypesupport

PREFIX = Path(sys.prefix)
FAMILIES = {"msg": convert_msg_to_idl, "srv": convert_srv_to_idl, "action": convert_action_to_idl}
GENERATORS = [
    GenerateC("c"),
    GenerateFastRTPSCTypesupport("fastrtps_c"),
    GenerateCTypesupport("c", typesupport_implementations=["rosidl_typesupport_fastrtps_c"]),
    GeneratePython("py", typesupport_implementations=["rosidl_typesupport_c"]),
]


# Each wheel announces its generators twice.
logging.disable(logging.WARNING)


def generate(package, made):
    """Python and C of a package's definitions."""
    definitions = []
    for family, convert in FAMILIES.items():
        for definition in sorted(package.glob(f"{family}/*.{family}")):
            (made / family).mkdir(parents=True, exist_ok=True)
            convert(package, package.name, definition.relative_to(package), made / family)
            definitions.append(f"{made}:{family}/{definition.stem}.idl")
    if not definitions:
        sys.exit(f"{package} has no definitions: they are expected in msg, srv and action")
    for generator in GENERATORS:
        generator.generate(package.name, definitions, [str(PREFIX / "share")], made)
    (made / "__init__.py").touch()


def build(made):
    """One library of all C and C++. Python's own functions are in the program that loads it."""
    library = made / f"{made.name}_s__rosidl_typesupport_c.so"
    headers = [made.parent, sysconfig.get_path("include"), numpy.get_include(),
               PREFIX / "include", *sorted(PREFIX.glob("include/*"))]
    objects = []
    for source in sorted([*made.rglob("*.c"), *made.rglob("*.cpp")]):
        compiler = "g++" if source.suffix == ".cpp" else "gcc"
        objects.append(f"{source}.o")
        run(compiler, "-O1", "-fPIC", *(f"-I{folder}" for folder in headers), "-c", source, "-o", objects[-1])
    run("g++", "-shared", *objects, "-Wl,--as-needed", *sorted(PREFIX.glob("lib/lib*.so")), "-o", library)


def run(*command):
    subprocess.run(command, check=True)


def install(made):
    home = Path(sysconfig.get_path("purelib")) / made.name
    shutil.rmtree(home, ignore_errors=True)
    leave = shutil.ignore_patterns("*.c", "*.cpp", "*.h", "*.o", "*.idl", "*.json", "detail")
    shutil.copytree(made, home, ignore=leave)


def main(package):
    with TemporaryDirectory() as folder:
        made = Path(folder) / package.name
        # The converters tell what they do.
        with contextlib.redirect_stdout(io.StringIO()):
            generate(package, made)
        build(made)
        install(made)
    # Whether it can be loaded.
    for family in FAMILIES:
        if (package / family).is_dir():
            importlib.import_module(f"{package.name}.{family}")
    importlib.import_module(f"{package.name}.{package.name}_s__rosidl_typesupport_c")


main(Path(sys.argv[1]).resolve())
