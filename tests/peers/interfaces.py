"""Makes a package of ROS 2 definitions, PACKAGE/{msg,srv,action}, one of the Python that runs this, for its rclpy.

The wheels bring rosidl's generators, headers and libraries; what is here takes the place of its build. All that is
generated becomes one library, which goes by the names of all those that rosidl looks for.
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
from rosidl_typesupport_introspection_c.cli import GenerateIntrospectionCTypesupport

PREFIX = Path(sys.prefix)
FAMILIES = {"msg": convert_msg_to_idl, "srv": convert_srv_to_idl, "action": convert_action_to_idl}
# How messages are written and read; rosidl chooses among these when it runs.
SUPPORTS = ["rosidl_typesupport_fastrtps_c", "rosidl_typesupport_introspection_c"]
PYTHON = GeneratePython("python", typesupport_implementations=["rosidl_typesupport_c"])
GENERATORS = [
    GenerateC("structures"),
    GenerateCTypesupport("choice", typesupport_implementations=SUPPORTS),
    GenerateFastRTPSCTypesupport("fastrtps"),
    GenerateIntrospectionCTypesupport("introspection"),
    PYTHON,
]

# Each wheel announces its generators twice.
logging.disable(logging.WARNING)


def generate(package, made):
    """Python and C of a package's definitions. Each generator in a folder of its own: some give files the same names."""
    definitions = []
    for family, convert in FAMILIES.items():
        for definition in sorted(package.glob(f"{family}/*.{family}")):
            (made / family).mkdir(exist_ok=True)
            convert(package, package.name, definition.relative_to(package), made / family)
            definitions.append(f"{made}:{family}/{definition.stem}.idl")
    if not definitions:
        sys.exit(f"{package} has no definitions: they are expected in msg, srv and action")
    for generator in GENERATORS:
        generator.generate(package.name, definitions, [str(PREFIX / "share")], made / generator.name / package.name)


def build(made, library):
    """The library of all C and C++. Python's own functions are in the program that loads it."""
    headers = [*(made / generator.name for generator in GENERATORS), sysconfig.get_path("include"), numpy.get_include(),
               PREFIX / "include", *sorted(PREFIX.glob("include/*"))]
    objects = []
    for source in sorted([*made.rglob("*.c"), *made.rglob("*.cpp")]):
        compiler = "g++" if source.suffix == ".cpp" else "gcc"
        objects.append(f"{source}.o")
        run(compiler, "-O1", "-fPIC", *(f"-I{folder}" for folder in headers), "-c", source, "-o", objects[-1])
    run("g++", "-shared", *objects, "-Wl,--as-needed", *sorted(PREFIX.glob("lib/lib*.so")), "-o", library)


def run(*command):
    subprocess.run(command, check=True)


def install(package, made):
    """The package, as a wheel would bring it."""
    home = Path(sysconfig.get_path("purelib")) / package
    library = home / f"{package}_s__rosidl_typesupport_c.so"
    shutil.rmtree(home, ignore_errors=True)
    shutil.copytree(made / PYTHON.name / package, home, ignore=shutil.ignore_patterns("*.c"))
    (home / "__init__.py").touch()
    names = [PREFIX / "lib" / f"lib{package}__{support}.so" for support in SUPPORTS]
    # Else it would be among what it is linked with.
    for name in names:
        name.unlink(missing_ok=True)
    build(made, library)
    for name in names:
        name.symlink_to(library)
    # Whether it can be loaded.
    importlib.import_module(f"{package}.{library.stem}")


def main(package):
    with TemporaryDirectory() as made:
        # The converters tell what they do.
        with contextlib.redirect_stdout(io.StringIO()):
            generate(package, Path(made))
        install(package.name, Path(made))


main(Path(sys.argv[1]).resolve())
