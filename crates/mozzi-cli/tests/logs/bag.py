"""Writes the rows of a CSV log as a bag of rosbag2: SQLite, in two files, with another topic between.

python bag.py LOG.csv FOLDER: columns t, theta_NAME, dtheta_NAME, tau_NAME.
"""

import sqlite3
import struct
import sys


class Cdr:
    def __init__(self):
        self.data = b""

    def put(self, form, *values):
        size = struct.calcsize("<" + form[-1])
        self.data += b"\0" * (-len(self.data) % size) + struct.pack("<" + form, *values)

    def text(self, text):
        self.put("I", len(text) + 1)
        self.data += text.encode() + b"\0"

    def numbers(self, values):
        self.put("I", len(values))
        for value in values:
            self.put("d", value)


def joint_state(t, names, groups):
    cdr = Cdr()
    cdr.put("i", int(t))
    cdr.put("I", round((t - int(t)) * 1e9))
    cdr.text("base")
    cdr.put("I", len(names))
    for name in names:
        cdr.text(name)
    for group in groups:
        cdr.numbers(group)
    return b"\0\1\0\0" + cdr.data


def main():
    lines = open(sys.argv[1]).read().split()
    header = lines[0].split(",")
    rows = [[float(cell) for cell in line.split(",")] for line in lines[1:]]
    names = [name[6:] for name in header if name.startswith("theta_")]
    columns = [[header.index(f"{group}_{name}") for name in names] for group in ["theta", "dtheta", "tau"]]
    half = len(rows) // 2
    for k, part in enumerate([rows[:half], rows[half:]]):
        bag = sqlite3.connect(f"{sys.argv[2]}/bag_{k}.db3")
        bag.executescript(
            "CREATE TABLE schema(schema_version INTEGER PRIMARY KEY, ros_distro TEXT NOT NULL);"
            "CREATE TABLE topics(id INTEGER PRIMARY KEY, name TEXT NOT NULL, type TEXT NOT NULL,"
            " serialization_format TEXT NOT NULL, offered_qos_profiles TEXT NOT NULL);"
            "CREATE TABLE messages(id INTEGER PRIMARY KEY, topic_id INTEGER NOT NULL, timestamp INTEGER NOT NULL,"
            " data BLOB NOT NULL);"
            "CREATE INDEX timestamp_idx ON messages (timestamp ASC);"
        )
        topic = "INSERT INTO topics VALUES (7, '/joint_states', 'sensor_msgs/msg/JointState', 'cdr', ?)"
        bag.execute(topic, ("qos " * 2000,))
        bag.execute("INSERT INTO topics VALUES (8, '/camera', 'sensor_msgs/msg/Image', 'cdr', '')")
        for row in part:
            t = 1.7e9 + row[0]
            message = joint_state(t, names, [[row[c] for c in group] for group in columns])
            insert = "INSERT INTO messages(topic_id, timestamp, data) VALUES (?, ?, ?)"
            bag.execute(insert, (7, round(t * 1e9) + 1000, message))
            if row[0] < 0.5:
                image = bytes(range(256)) * 40
                bag.execute(insert, (8, round(t * 1e9), image))
        bag.commit()
        bag.close()


main()
