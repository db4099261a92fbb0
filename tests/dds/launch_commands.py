"""Prints the commands that launch files of ROS 2 would run: python3 launch_commands.py FOLDER LAUNCH_FILE [ARGUMENT:=VALUE ...]

Replaces the packages `launch` and `launch_ros`, which no package index has, as far as our launch files use them.
Composes command lines as launch_ros does. Prints a JSON list of commands; parameters go to files in FOLDER.
"""
import json
import pathlib
import runpy
import sys
import types

import yaml

folder = pathlib.Path(sys.argv[1])
commands = []


class Configuration:
    def __init__(self, name):
        self.name = name


def text(value, values):
    """Returns a text, or the value of a substitution."""
    return text(values[value.name], values) if isinstance(value, Configuration) else value


class Description(list):
    def __init__(self, actions):
        super().__init__(actions)

    def run(self, values):
        for action in self:
            action.run(values)


class Argument:
    def __init__(self, name, *, default_value=None, description):
        self.name, self.default = name, default_value
        assert description

    def run(self, values):
        if self.name not in values:
            assert self.default is not None, f"launch argument {self.name} is required"
            values[self.name] = self.default


class Include:
    def __init__(self, source, *, launch_arguments):
        self.source, self.arguments = source, dict(launch_arguments)

    def run(self, values):
        inner = {name: text(value, values) for name, value in self.arguments.items()}
        describe(self.source).run(inner)


class Condition:
    def __init__(self, value):
        self.value = value

    def holds(self, values):
        return text(self.value, values) == "true"


class Node:
    def __init__(self, *, executable, package=None, arguments=(), namespace=None, remappings=(), parameters=(),
                 condition=None, output="log"):
        self.words = [executable, *arguments]
        self.namespace, self.remappings, self.parameters = namespace, remappings, parameters
        self.condition = condition

    def run(self, values):
        if self.condition and not self.condition.holds(values):
            return
        words = [text(word, values) for word in self.words] + ["--ros-args"]
        if self.namespace is not None:
            space = text(self.namespace, values)
            words += ["-r", "__ns:=" + ("" if space.startswith("/") else "/") + space]
        for entry in self.parameters:
            file = text(entry, values)
            if isinstance(entry, dict):
                block = {name: text(value, values) for name, value in entry.items()}
                file = folder / f"launch_params_{len(list(folder.glob('launch_params_*')))}"
                file.write_text(yaml.safe_dump({"/**": {"ros__parameters": block}}))
            words += ["--params-file", str(file)]
        for old, new in self.remappings:
            words += ["-r", f"{text(old, values)}:={text(new, values)}"]
        commands.append(words)


def describe(path):
    return runpy.run_path(path)["generate_launch_description"]()


for name, contents in {
    "launch": {"LaunchDescription": Description},
    "launch.actions": {"DeclareLaunchArgument": Argument, "IncludeLaunchDescription": Include},
    "launch.conditions": {"IfCondition": Condition},
    "launch.launch_description_sources": {"PythonLaunchDescriptionSource": lambda path: path},
    "launch.substitutions": {"LaunchConfiguration": Configuration},
    "launch_ros": {},
    "launch_ros.actions": {"Node": Node},
    "launch_ros.parameter_descriptions": {"ParameterValue": lambda value, value_type: value},
}.items():
    sys.modules[name] = types.ModuleType(name)
    vars(sys.modules[name]).update(contents)

describe(sys.argv[2]).run(dict(word.split(":=", 1) for word in sys.argv[3:]))
print(json.dumps(commands))
