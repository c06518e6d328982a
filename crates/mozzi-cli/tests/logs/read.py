"""Reads a motion's files by their own libraries: python read.py FOLDER > found.json

Of each file motion.* in the folder: columns by name, or of MCAP the messages.
"""

import json
import pathlib
import sys

import numpy
import pyarrow.feather
import pyarrow.parquet


def table(found):
    return {name: found.column(name).to_pylist() for name in found.column_names}


def columns(array):
    return {name: array[name].tolist() for name in array.dtype.names}


def messages(path):
    from mcap.reader import make_reader
    from mcap_ros2.decoder import DecoderFactory

    joints, frames, energy = [], [], []
    with open(path, "rb") as file:
        reader = make_reader(file, decoder_factories=[DecoderFactory()])
        for schema, channel, message, decoded in reader.iter_decoded_messages():
            if channel.topic == "/joint_states":
                stamp = decoded.header.stamp.sec + 1e-9 * decoded.header.stamp.nanosec
                joints.append([message.log_time, stamp, decoded.name, decoded.position, decoded.velocity, decoded.effort])
            elif channel.topic == "/tf":
                frames.append({t.child_frame_id: [t.header.frame_id, *numbers(t.transform)] for t in decoded.transforms})
            elif channel.topic == "/kinetic_energy":
                energy.append(decoded.data)
    return {"joints": joints, "frames": frames, "kinetic_energy": energy}


def numbers(transform):
    p, q = transform.translation, transform.rotation
    return [q.w, q.x, q.y, q.z, p.x, p.y, p.z]


READERS = {
    ".npy": lambda path: columns(numpy.load(path)),
    ".npz": lambda path: {name: array.tolist() for name, array in numpy.load(path).items()},
    ".arrow": lambda path: table(pyarrow.feather.read_table(path)),
    ".parquet": lambda path: table(pyarrow.parquet.read_table(path)),
    ".mcap": messages,
}

files = sorted(path for path in pathlib.Path(sys.argv[1]).iterdir() if path.suffix in READERS)
print(json.dumps({path.suffix: READERS[path.suffix](path) for path in files}))
