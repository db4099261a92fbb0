"""Checks a Kubernetes Job against batch/v1, as far as deploy/kubernetes uses it, and prints as JSON the words
of the command of an index's pod: python3 check_job.py FILE INDEX"""

import json
import sys

import jsonschema
import yaml

TEXT = {"type": "string", "minLength": 1}
NAME = {"type": "string", "pattern": "^[a-z0-9]([-a-z0-9]*[a-z0-9])?$"}
COUNT = {"type": "integer", "minimum": 1}
QUANTITIES = {"type": "object", "additionalProperties": {"type": "string", "pattern": r"^\d+(\.\d+)?(m|[KMGT]i?)?$"},
              "propertyNames": {"enum": ["cpu", "memory"]}}


def block(required, **more):
    return {"type": "object", "required": required, "properties": more, "additionalProperties": False}


def some(items):
    return {"type": "array", "minItems": 1, "items": items}


CONTAINER = block(
    ["name", "image"], name=NAME, image=TEXT, workingDir=TEXT, command=some(TEXT), args=some(TEXT),
    env=some(block(["name"], name=TEXT, value=TEXT, valueFrom=block(["fieldRef"], fieldRef=block(["fieldPath"], fieldPath=TEXT)))),
    resources=block([], requests=QUANTITIES, limits=QUANTITIES),
    volumeMounts=some(block(["name", "mountPath"], name=NAME, mountPath=TEXT)))
POD = block(["restartPolicy", "containers"], restartPolicy={"enum": ["Never", "OnFailure"]}, containers=some(CONTAINER),
            volumes=some(block(["name"], name=NAME, persistentVolumeClaim=block(["claimName"], claimName=NAME))))
JOB = block(
    ["apiVersion", "kind", "metadata", "spec"], apiVersion={"const": "batch/v1"}, kind={"const": "Job"},
    metadata=block(["name"], name=NAME),
    spec=block(["completions", "completionMode", "template"], completions=COUNT, parallelism=COUNT, backoffLimit=COUNT,
               completionMode={"const": "Indexed"}, template=block(["spec"], spec=POD)))

job = yaml.safe_load(open(sys.argv[1]))
jsonschema.validate(job, JOB)
pod = job["spec"]["template"]["spec"]
container = pod["containers"][0]
assert {mount["name"] for mount in container["volumeMounts"]} == {volume["name"] for volume in pod["volumes"]}
words = [word.replace("$(JOB_COMPLETION_INDEX)", sys.argv[2]) for word in container["args"]]
assert words[-1] == f"{sys.argv[2]}/{job['spec']['completions']}", "as many shards as completions"
print(json.dumps(words))
