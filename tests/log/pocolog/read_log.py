"""Reads a pocolog v2 file without knowledge of its types: registry, marshalling and index as Rock defines them.
Prints {"streams": {name: {"type", "metadata", "samples": [[logged us, time us, value]...]}}, "index": bool} as JSON,
or fails. Python's standard library only."""
import json
import os
import re
import struct
import sys
import xml.etree.ElementTree
import zlib

NUMBERS = {("sint", 1): "b", ("sint", 4): "i", ("sint", 8): "q", ("uint", 1): "B", ("uint", 2): "H", ("uint", 4): "I",
           ("uint", 8): "Q", ("float", 4): "f", ("float", 8): "d"}


class Registry:
    def __init__(self, xml_text):
        root = xml.etree.ElementTree.fromstring(xml_text)
        assert root.tag == "typelib", root.tag
        self.nodes = {node.get("name"): node for node in root}

    def size(self, name):
        if name.endswith("]"):
            base, count = name[:-1].rsplit("[", 1)
            return self.size(base) * int(count)
        node = self.nodes[name]
        return 4 if node.tag == "enum" else int(node.get("size"))

    def leaves(self, name, offset=0, path=()):
        """(offset in memory, size in memory, path, type) of everything except compounds, in order."""
        if name.endswith("]"):
            base, count = name[:-1].rsplit("[", 1)
            for i in range(int(count)):
                yield from self.leaves(base, offset + i * self.size(base), path + (i,))
        elif self.nodes[name].tag == "compound":
            for field in sorted(self.nodes[name], key=lambda f: int(f.get("offset"))):
                place = offset + int(field.get("offset"))
                yield from self.leaves(field.get("type"), place, path + (field.get("name"),))
        else:
            yield offset, self.size(name), path, name


class Sample:
    def __init__(self, registry, data):
        self.registry, self.data, self.at = registry, data, 0

    def take(self, count):
        assert self.at + count <= len(self.data), "the sample ends too early"
        self.at += count
        return self.data[self.at - count:self.at]

    def value(self, name, keeps_tail=False):
        end, values = 0, {}
        for offset, size, path, leaf in self.registry.leaves(name):
            self.take(offset - end)  # padding between fields is written
            end = offset + size
            values[".".join(map(str, path))] = self.leaf(leaf)
        if keeps_tail:
            self.take(self.registry.size(name) - end)
        return values[""] if list(values) == [""] else values

    def leaf(self, name):
        node = self.registry.nodes[name]
        if node.tag == "enum":
            number, = struct.unpack("<i", self.take(4))
            return next((v.get("symbol") for v in node if int(v.get("value")) == number), number)
        if node.tag == "numeric":
            size = int(node.get("size"))
            number, = struct.unpack("<" + NUMBERS[node.get("category"), size], self.take(size))
            return number if number == number else None  # JSON has no NaN
        assert node.tag == "container", node.tag
        count, = struct.unpack("<Q", self.take(8))
        if node.get("kind") == "/std/string":
            return self.take(count).decode()
        return [self.value(node.get("of"), keeps_tail=True) for _ in range(count)]


def texts(payload):
    assert payload[0] == 1, "not a data stream"
    at = 1
    for _ in range(4):
        size, = struct.unpack_from("<I", payload, at)
        yield payload[at + 4:at + 4 + size].decode()
        at += 4 + size
    assert at == len(payload), "the declaration has bytes left"


def flat(yaml):
    """A flat map of double-quoted scalars: as in JSON, except \\x09 and similar."""
    pairs = (line.split(": ", 1) for line in yaml.splitlines())
    return {key: json.loads(re.sub(r"(?<!\\)\\x", r"\\u00", value)) for key, value in pairs}


def read(path):
    data = open(path, "rb").read()
    assert data[:16] == b"POCOSIM\0" + struct.pack("<II", 2, 0), "prologue"
    streams, at = [], 16
    while at < len(data):
        kind, _, number, size = struct.unpack_from("<BBHI", data, at)
        payload = data[at + 8:at + 8 + size]
        assert len(payload) == size, "the file ends within a block"
        if kind == 1:
            assert number == len(streams), "declared out of order"
            name, typename, xml_text, yaml = texts(payload)
            streams.append({"name": name, "type": typename, "registry": Registry(xml_text), "metadata": flat(yaml),
                            "declared": at, "blocks": [], "samples": []})
        elif kind == 2:
            stream = streams[number]
            rs, ru, ls, lu, count, compressed = struct.unpack_from("<IIIIIB", payload)
            assert count == size - 21, "sizes"
            body = zlib.decompress(payload[21:]) if compressed else payload[21:]
            sample = Sample(stream["registry"], body)
            stream["samples"].append([rs * 1000000 + ru, ls * 1000000 + lu, sample.value(stream["type"])])
            assert sample.at == len(body), "parts of the provided buffer have not been used"
            stream["blocks"].append(at)
        else:
            assert kind == 3, f"block type {kind} at {at}"
        at += 8 + size
    return data, streams


def expected_index(data, streams, modified):
    head = b"POCOSIM_INDEX" + struct.pack(">IQQQ", 3, len(data), modified, len(streams))
    tables, place = b"", len(head) + 64 * len(streams)
    for stream in streams:
        samples = stream["samples"]
        first, last = (samples[0], samples[-1]) if samples else ([0, 0], [0, 0])
        head += struct.pack(">8Q", stream["declared"], place + len(tables), first[1], len(samples), first[0], last[0],
                            first[1], last[1])
        for block, sample in zip(stream["blocks"], samples):
            tables += struct.pack(">QQ", block, sample[1] - first[1])
    return head + tables


def main(path):
    data, streams = read(path)
    index = path[:-len(".log")] + ".idx"
    found = open(index, "rb").read() if os.path.exists(index) else None
    if found is not None:
        modified = os.stat(path).st_mtime_ns // 1000
        assert found == expected_index(data, streams, modified), "the index is another"
    summary = {s["name"]: {key: s[key] for key in ("type", "metadata", "samples")} for s in streams}
    print(json.dumps({"streams": summary, "index": found is not None}))


main(sys.argv[1])
