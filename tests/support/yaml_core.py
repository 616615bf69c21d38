"""The core schema of YAML 1.2 with PyYAML, which reads 1e-9 as a text, 010 as eight and `no` as false without it."""

import re

import yaml


class Core(yaml.SafeLoader):
    pass


def integer(loader: Core, node: yaml.ScalarNode) -> int:
    return int(node.value, {"0o": 8, "0x": 16}.get(node.value[:2], 10))


Core.yaml_implicit_resolvers = {}  # not those of YAML 1.1
for tag, pattern in {
    "null": "null|Null|NULL|~|",
    "bool": "true|True|TRUE|false|False|FALSE",
    "int": r"[-+]?[0-9]+|0o[0-7]+|0x[0-9a-fA-F]+",
    "float": r"[-+]?(\.[0-9]+|[0-9]+(\.[0-9]*)?)([eE][-+]?[0-9]+)?|[-+]?\.(inf|Inf|INF)|\.(nan|NaN|NAN)",
}.items():
    Core.add_implicit_resolver(f"tag:yaml.org,2002:{tag}", re.compile(rf"(?:{pattern})\Z"), None)
Core.add_constructor("tag:yaml.org,2002:int", integer)


def read(text: str) -> object:
    return yaml.load(text, Core)
