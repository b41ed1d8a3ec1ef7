"""Compares the HDF5 and the MATLAB export of a recording with its CSV export, value by value.

usage: read_exports.py FILE.h5 FILE.mat CSV_DIRECTORY TOPIC...
CSV_DIRECTORY has one file per topic: crane_state.csv. Prints the number of compared values; exit code 1 at a difference."""
import csv
import re
import sys

import h5py
import numpy
import scipy.io


def columns_of(path):
    """Texts of a CSV file by field, without indices: {"axis.position": [[row 0], [row 1], ...]}."""
    with open(path, newline="", encoding="utf-8") as file:
        rows = list(csv.reader(file))
    fields = {}
    for i, name in enumerate(rows[0]):
        fields.setdefault(re.sub(r"\[\d+\]", "", name), []).append(i)
    return {field: [[row[i] for i in places] for row in rows[1:]] for field, places in fields.items()}


def same(text, value, enumerators):
    if enumerators is not None:
        return enumerators[int(value)] == text or (enumerators == ["false", "true"] and text == str(int(value)))
    if isinstance(value, (bytes, str)):
        return (value.decode() if isinstance(value, bytes) else value) == text
    if numpy.issubdtype(type(value), numpy.integer):
        return int(text) == int(value)
    if numpy.issubdtype(type(value), numpy.bool_):
        return text == str(int(value))
    expected = float("nan") if text in ("nan", "null") else float(text)
    if value.dtype == numpy.float32:
        expected = numpy.float32(expected)
    return expected == value or (expected != expected and value != value)


def compare(place, texts, values, enumerators):
    values = numpy.asarray(values)
    if values.ndim == 1:
        values = values.reshape(-1, 1)
    if values.shape != (len(texts), len(texts[0]) if texts else values.shape[1]):
        sys.exit(f"{place}: {values.shape} values, {len(texts)} rows in the CSV file")
    for row, cells in enumerate(texts):
        for i, text in enumerate(cells):
            value = values[row, i]
            if isinstance(value, numpy.ndarray):  # a MATLAB cell; an empty text has no characters
                value = str(value.item()) if value.size else ""
            if not same(text, value, enumerators):
                sys.exit(f"{place}[{row}, {i}]: {value!r}, in the CSV file {text!r}")
    return values.size


def decoded(values):
    return [value.decode() if isinstance(value, bytes) else str(value) for value in values]


def compare_hdf5(file, topic, columns):
    group, compared = file[topic], 0
    if set(group) != set(columns):
        sys.exit(f"{topic}: fields {sorted(group)}, in the CSV file {sorted(columns)}")
    for name, data in group.items():
        enumerators = decoded(data.attrs["enumerators"]) if "enumerators" in data.attrs else None
        compared += compare(f"hdf5 {topic}/{name}", columns[name], data[()], enumerators)
        if name.endswith("_ns"):
            assert numpy.issubdtype(data.dtype, numpy.integer), name
    assert group.attrs["samples"] == len(columns["log_time_ns"])
    return compared


def compare_matlab(file, topic, columns):
    topic_struct, compared = file[topic.replace("/", "_")][0, 0], 0
    names = set(topic_struct.dtype.names) - {"units", "enumerators", "type"}
    if names != {name.replace(".", "_") for name in columns}:
        sys.exit(f"{topic}: members {sorted(names)}, in the CSV file {sorted(columns)}")
    for name, texts in columns.items():
        member = name.replace(".", "_")
        enumerators = None
        if "enumerators" in topic_struct.dtype.names and member in topic_struct["enumerators"][0, 0].dtype.names:
            enumerators = [str(cell[0].item()) for cell in topic_struct["enumerators"][0, 0][member]]
        compared += compare(f"matlab {topic}.{member}", texts, topic_struct[member], enumerators)
        if name.endswith("_ns"):
            assert numpy.issubdtype(topic_struct[member].dtype, numpy.integer), name
    return compared


def main():
    hdf5, matlab, directory, topics = h5py.File(sys.argv[1], "r"), scipy.io.loadmat(sys.argv[2]), sys.argv[3], sys.argv[4:]
    compared = 0
    for topic in topics:
        columns = columns_of(f"{directory}/{topic.replace('/', '_')}.csv")
        compared += compare_hdf5(hdf5, topic, columns) + compare_matlab(matlab, topic, columns)
    state, reference = hdf5["crane/state"], hdf5["crane/reference"]
    assert state["trolley_position_m"].attrs["unit"] == "m"
    assert state["log_time_ns"].attrs["unit"] == "ns"
    assert state["log_time_ns"].dtype == numpy.int64
    assert state["applied_v"].shape[1] == 3 and state["applied_v"].attrs["unit"] == "V"
    assert list(reference["axis.position"].attrs["unit"]) == ["m", "rad", "m"]
    units = matlab["crane_state"][0, 0]["units"][0, 0]
    assert units["trolley_position_m"].item() == "m"
    about = matlab["recording"][0, 0]
    assert about["crane_rig"].item() == hdf5.attrs["crane.rig"] == "virginia_tech_tower"
    assert about["rig_toml"].item() == hdf5.attrs["rig.toml"] and "name" in hdf5.attrs["rig.toml"]
    assert hdf5.attrs["exported_by"].startswith("crane ")
    print(f"{compared} values are equal")


main()
