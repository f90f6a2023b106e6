#!/usr/bin/env python3
"""Writes a rosbag2 as ROS 2's recorder lays it out, with Python's sqlite3.

  write_rosbag2.py FOLDER STATE SCANS

STATE: closed; killed: no metadata.yaml, the last messages in the -wal file; message: each packed by zstd; file: the
file packed by zstd. Scan k has 100 + k points; what they are, test_foreign_recordings.cpp knows.
"""
import os
import sqlite3
import struct
import subprocess
import sys

FIELDS = [(b"x", 0, 7), (b"y", 4, 7), (b"z", 8, 7), (b"intensity", 12, 7), (b"ring", 16, 4), (b"time", 18, 8)]


class Cdr:
    def __init__(self):
        self.data = b""

    def number(self, kind, value):
        size = struct.calcsize(kind)
        self.data += b"\0" * (-len(self.data) % size) + struct.pack("<" + kind, value)

    def text(self, value):
        self.number("I", len(value) + 1)
        self.data += value + b"\0"


def cloud(k, count):
    cdr = Cdr()
    for number in (1700000000 + k // 10, (k % 10) * 100000000):
        cdr.number("I", number)
    cdr.text(b"lidar")
    for number in (1, count, len(FIELDS)):
        cdr.number("I", number)
    for name, offset, kind in FIELDS:
        cdr.text(name)
        cdr.number("I", offset)
        cdr.number("B", kind)
        cdr.number("I", 1)
    cdr.number("B", 0)
    for number in (26, 26 * count, 26 * count):
        cdr.number("I", number)
    cdr.data += b"".join(struct.pack("<ffffHd", k + 0.25 * i, -i, 0.5 * k, i % 256, i % 64, 0.1 * i / count)
                         for i in range(count))
    cdr.number("B", 1)
    return b"\0\1\0\0" + cdr.data


def packed(data):
    return subprocess.run(["zstd", "-c", "-q"], input=data, stdout=subprocess.PIPE, check=True).stdout


def main():
    folder, state, scans = sys.argv[1:]
    os.makedirs(folder)
    file = os.path.join(folder, "recording_0.db3")
    base = sqlite3.connect(file)
    base.execute("PRAGMA journal_mode=WAL")
    base.execute("CREATE TABLE topics(id INTEGER PRIMARY KEY, name TEXT NOT NULL, type TEXT NOT NULL, "
                 "serialization_format TEXT NOT NULL, offered_qos_profiles TEXT NOT NULL)")
    base.execute("CREATE TABLE messages(id INTEGER PRIMARY KEY, topic_id INTEGER NOT NULL, timestamp INTEGER NOT NULL, "
                 "data BLOB NOT NULL)")
    base.execute("CREATE INDEX timestamp_idx ON messages (timestamp ASC)")
    for name, kind in (("/chatter", "std_msgs/msg/String"), ("/lidar/points", "sensor_msgs/msg/PointCloud2")):
        base.execute("INSERT INTO topics(name, type, serialization_format, offered_qos_profiles) "
                     "VALUES(?, ?, 'cdr', '')", (name, kind))
    base.commit()
    for k in range(int(scans)):
        if state == "killed" and k == int(scans) // 2:
            base.execute("PRAGMA wal_checkpoint(TRUNCATE)")
            base.execute("PRAGMA wal_autocheckpoint=0")
        for topic, data in ((1, b"\0\1\0\0\2\0\0\0x\0"), (2, cloud(k, 100 + k))):
            base.execute("INSERT INTO messages(topic_id, timestamp, data) VALUES(?, ?, ?)",
                         (topic, 1700000000000000000 + k * 100000000, packed(data) if state == "message" else data))
        base.commit()
    if state == "killed":
        os._exit(0)
    base.execute("PRAGMA journal_mode=DELETE")
    base.close()
    name = "recording_0.db3"
    if state == "file":
        subprocess.run(["zstd", "-q", "--rm", file, "-o", file + ".zstd"], check=True)
        name += ".zstd"
    with open(os.path.join(folder, "metadata.yaml"), "w") as metadata:
        metadata.write(f"rosbag2_bagfile_information:\n  version: 5\n  storage_identifier: sqlite3\n"
                       f"  relative_file_paths:\n    - old_folder/{name}\n  files:\n    - path: {name}\n")


main()
