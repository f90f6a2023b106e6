#!/usr/bin/python3
"""Writes a bag with ROS's own rosbag (Debian: python3-rosbag, python3-sensor-msgs), which is not ours.

  write_rosbag1.py FILE none|bz2|lz4 SCANS

Scan k has 100 + k points; what they are, test_foreign_recordings.cpp knows.
"""
import struct
import sys

import genpy
import rosbag
from sensor_msgs.msg import PointCloud2, PointField
from std_msgs.msg import Header, String

FIELDS = [("x", 0, 7), ("y", 4, 7), ("z", 8, 7), ("intensity", 12, 7), ("ring", 16, 4), ("time", 18, 8)]


def cloud(k, count):
    data = b"".join(struct.pack("<ffffHd", k + 0.25 * i, -i, 0.5 * k, i % 256, i % 64, 0.1 * i / count)
                    for i in range(count))
    stamp = genpy.Time(1700000000 + k // 10, (k % 10) * 100000000)
    return PointCloud2(header=Header(stamp=stamp, frame_id="lidar"), height=1, width=count,
                       fields=[PointField(name, offset, kind, 1) for name, offset, kind in FIELDS],
                       is_bigendian=False, point_step=26, row_step=26 * count, data=data, is_dense=True)


def main():
    file, compression, scans = sys.argv[1:]
    with rosbag.Bag(file, "w", compression=compression, chunk_threshold=20000) as bag:
        for k in range(int(scans)):
            time = genpy.Time(1700000000 + k // 10, (k % 10) * 100000000)
            bag.write("/chatter", String("x" * (k % 9)), time)
            bag.write("/lidar/points", cloud(k, 100 + k), time)


main()
