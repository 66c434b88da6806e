"""The JSON Schema that the program prints accepts every shipped scene and study, and no misspelt key.

test_json_schema.py BOUGH SOURCE. The few words of JSON Schema that it uses are checked here; where the
package jsonschema is installed, by it too.
"""
import glob
import json
import subprocess
import sys

try:
    import yaml
except ImportError:
    print("skipped: Python has no yaml")
    sys.exit(77)
try:
    import jsonschema
except ImportError:
    jsonschema = None

TYPES = {"object": dict, "array": list, "string": str, "boolean": bool, "integer": int}


def is_type(value, name):
    if isinstance(value, bool):
        return name == "boolean"
    return isinstance(value, (int, float) if name == "number" else TYPES[name])


def faults(value, schema, path=""):
    """What of the value the schema does not allow, as texts."""
    if "anyOf" in schema:
        each = [faults(value, one, path) for one in schema["anyOf"]]
        return [] if any(not one for one in each) else min(each, key=len)
    types = schema.get("type", [])
    types = [types] if isinstance(types, str) else types
    if types and not any(is_type(value, name) for name in types):
        return [f"{path}: {value!r} is none of {types}"]
    if "enum" in schema and value not in schema["enum"]:
        return [f"{path}: {value!r} is none of {schema['enum']}"]
    found = []
    if isinstance(value, list):
        if not schema.get("minItems", 0) <= len(value) <= schema.get("maxItems", len(value)):
            found.append(f"{path}: {len(value)} items")
        for i, item in enumerate(value):
            found += faults(item, schema.get("items", {}), f"{path}[{i}]")
    if isinstance(value, dict) and "properties" in schema:
        found += [f"{path}.{key} is missing" for key in schema["required"] if key not in value]
        for key, item in value.items():
            if key in schema["properties"]:
                found += faults(item, schema["properties"][key], f"{path}.{key}")
            else:
                found.append(f"{path}.{key} is not known")
    return found


def main(bough, source):
    def schema(topic):
        command = [bough, "help", topic, "--json-schema"]
        return json.loads(subprocess.run(command, check=True, capture_output=True).stdout)

    class Loader(yaml.SafeLoader):
        """YAML 1.2: only true and false are truth values, and 1e6 is a number."""

    Loader.yaml_implicit_resolvers = {
        letter: [(tag, pattern) for tag, pattern in rules if not tag.endswith((":bool", ":float"))]
        for letter, rules in yaml.SafeLoader.yaml_implicit_resolvers.items()
    }
    import re
    Loader.add_implicit_resolver("tag:yaml.org,2002:bool", re.compile("^(true|false)$"), "tf")
    number = re.compile(r"^[-+]?(\.[0-9]+|[0-9]+\.?[0-9]*)([eE][-+]?[0-9]+)?$")
    Loader.add_implicit_resolver("tag:yaml.org,2002:float", number, "-+.0123456789")

    schemas = {"scene": schema("scene"), "study": schema("study")}
    counts = {"scene": 0, "study": 0}
    failed = 0
    for path in sorted(glob.glob(source + "/apps/*/*.yaml") + glob.glob(source + "/tests/data/scenes/*.yaml")):
        with open(path) as file:
            data = yaml.load(file, Loader)
        kind = data.get("kind")
        topic = "scene" if "bodies" in data else "study"
        if topic == "study" and kind not in ("work-precision", "timing", "stability", "sweep", "load-set"):
            continue
        counts[topic] += 1
        found = faults(data, schemas[topic])
        if jsonschema and not found:
            found = [e.message for e in jsonschema.Draft202012Validator(schemas[topic]).iter_errors(data)]
        for text in found:
            print(f"{path}{text}")
            failed += 1
        if not faults(dict(data, titel="x"), schemas[topic]):
            print(f"{path}: a misspelt key is accepted")
            failed += 1
    print(counts)
    return failed > 0 or counts["scene"] < 40 or counts["study"] < 5


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
