"""Prints the errors of YAML files by a JSON schema, one per line: python3 check_schema.py SCHEMA FILE..."""
import json
import sys

import jsonschema
import yaml

with open(sys.argv[1]) as file:
    schema = json.load(file)
jsonschema.Draft202012Validator.check_schema(schema)
validator = jsonschema.Draft202012Validator(schema)
for name in sys.argv[2:]:
    with open(name) as file:
        document = yaml.safe_load(file)
    for error in validator.iter_errors(document):
        print(f"{name}: {'.'.join(map(str, error.absolute_path))}: {error.message[:200]}")
