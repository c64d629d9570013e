"""Reads an exported MCAP file with the public `mcap` package and checks what is in it.

Usage: mcap_reader.py FILE.mcap COUNTS.json: COUNTS is what `tubetwin replay --mcap --json` printed.
"""

import base64
import json
import math
import struct
import sys

import jsonschema
from mcap.reader import NonSeekingReader, make_reader

FILE, COUNTS = sys.argv[1], json.load(open(sys.argv[2]))["mcap"]


def rotate(q, p):
    """The point p turned by the quaternion q."""
    w, u = q["w"], (q["x"], q["y"], q["z"])
    cross = lambda a, b: (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])
    t = tuple(2 * c for c in cross(u, p))
    v = cross(u, t)
    return tuple(p[i] + w * t[i] + v[i] for i in range(3))


def vector(v):
    return (v["x"], v["y"], v["z"])


def messages():
    with open(FILE, "rb") as file:
        reader = make_reader(file, validate_crcs=True)
        for schema, channel, message in reader.iter_messages():
            yield schema, channel.topic, message, json.loads(message.data)


def check_summary():
    with open(FILE, "rb") as file:
        reader = make_reader(file, validate_crcs=True)
        summary = reader.get_summary()
        counted = {c.topic: summary.statistics.channel_message_counts[i] for i, c in summary.channels.items()}
        assert counted == COUNTS, (counted, COUNTS)
        assert summary.statistics.chunk_count == len(summary.chunk_indexes) > 1
        attachment = next(iter(reader.iter_attachments()))
        assert attachment.name == "config.resolved.toml" and b"[pile]" in attachment.data
        assert attachment.data == open("round/config.resolved.toml", "rb").read()
        metadata = next(iter(reader.iter_metadata()))
        assert metadata.name == "tubetwin" and metadata.metadata["seed"] == "2", metadata
        assert metadata.metadata["complete"] == "true"


def check_without_index():
    """The same messages when the file is read from its start, as from a pipe."""
    with open(FILE, "rb") as file:
        count = sum(1 for _ in NonSeekingReader(file, validate_crcs=True).iter_messages())
    assert count == sum(COUNTS.values())


def check_transforms(frames, message):
    """Rotations are unit quaternions; who hangs below whom goes into `frames`."""
    for transform in message["transforms"]:
        q = transform["rotation"]
        assert abs(math.sqrt(sum(c * c for c in q.values())) - 1) < 1e-9
        frames[transform["child_frame_id"]] = transform["parent_frame_id"]


def check_cloud(cloud):
    names = [field["name"] for field in cloud["fields"]]
    assert names == ["x", "y", "z", "intensity"] and cloud["point_stride"] == 16
    data = base64.b64decode(cloud["data"], validate=True)
    assert len(data) % 16 == 0 and len(data) > 16 * 10000
    q, p = cloud["pose"]["orientation"], vector(cloud["pose"]["position"])
    heights = []
    for at in range(0, len(data), 16 * 97):
        x, y, z, intensity = struct.unpack_from("<4f", data, at)
        assert 0 <= intensity <= 1
        turned = rotate(q, (x, y, z))
        heights.append(turned[2] + p[2])
    # In frame `bin` most of what a view sees is the floor, and nothing is far below it.
    near = sum(abs(h) < 0.005 for h in heights)
    assert cloud["frame_id"] == "bin" and near > len(heights) / 3, (near, len(heights))


def main():
    check_summary()
    check_without_index()
    seen, frames, last = {}, {}, {}
    validators = {}
    for schema, topic, message, value in messages():
        assert schema.encoding == "jsonschema"
        if schema.id not in validators:
            text = json.loads(schema.data)
            assert text["title"] == schema.name
            validators[schema.id] = jsonschema.Draft7Validator(text)
        # Every message keeps its schema; of the many alike a sample is enough.
        seen[topic] = seen.get(topic, 0) + 1
        if seen[topic] <= 50 or seen[topic] % 50 == 0:
            validators[schema.id].validate(value)
        if "timestamp" in value:
            stamp = value["timestamp"]["sec"] * 10**9 + value["timestamp"]["nsec"]
            assert stamp == message.log_time
        assert message.log_time >= last.get(topic, 0)
        last[topic] = message.log_time
        if topic == "/tf":
            check_transforms(frames, value)
        elif topic == "/cloud":
            check_cloud(value)
        elif topic == "/joint_states":
            assert [j["name"] for j in value["joints"]][:2] == ["joint_1_s", "joint_2_l"]
            assert all(abs(j["position"]) < 2 * math.pi for j in value["joints"])
        elif topic == "/wrench":
            # What hangs below the sensor weighs about 10 N, its load is along z of K.
            assert -20 < value["force"]["z"] < 60
    assert seen == COUNTS, (seen, COUNTS)
    assert all(COUNTS[topic] > 0 for topic in COUNTS), COUNTS
    moving = {f"link_{i}": "base" for i in range(1, 7)}
    assert frames == {**moving, "flange": "base", "bin": "base", "tray": "base", "wrist": "flange",
                      "tool": "flange", "scanner": "flange"}, frames
    print("read by the public mcap package:", seen)


main()
