#!/usr/bin/env python3
"""`trajectory_error` against `evo`, on trajectories of the simulated room.

    build/peers/bin/python test/peers/trajectories.py [--tools DIRECTORY] [--seeds N]

True poses are those of `simulate_davis --scene room`. Estimates are made of them: turned, moved, scaled,
with a drift that wanders and noise. Three kinds for each room:

- `same stamps`: an estimate for each true pose. Both programs get the same files' worth of poses.
- `between`: estimates at instants between the true poses. trajectory_error interpolates the truth linearly;
  evo takes the true pose that is nearest in time, and has no interpolation. So evo gets the truth
  interpolated by numpy, at the instants of the estimates. The last column says what evo itself makes of
  the two files (nearest pose within 10 ms): that difference is not checked.
- `left out`: besides, estimates before the first and after the last true pose, a second without truth,
  and estimates that are no numbers. trajectory_error leaves these out and counts them; evo would stop at
  the numbers and, without interpolation, find other pairs. So evo gets the rest, chosen by numpy.

Alignments se3 and sim3 are evo's own. It has none by yaw and translation: scipy looks for the yaw, evo
measures what remains. RMSE, median, largest distance and scale must agree within 1 % (and half of the last
digit that trajectory_error prints), the number of estimates that were left out exactly. Exit code 1: they
do not.
"""
import argparse
import pathlib
import re
import subprocess
import sys
import tempfile

import numpy
from evo.core import metrics, sync
from evo.core.trajectory import PoseTrajectory3D
from rosbags.rosbag1 import Reader, Writer
from rosbags.typesys import Stores, get_typestore
from scipy.optimize import minimize_scalar

ROOT = pathlib.Path(__file__).resolve().parents[2]
STORE = get_typestore(Stores.ROS1_NOETIC)
POSE = "geometry_msgs/msg/PoseStamped"
TRUTH, ESTIMATE = "/dvs/ground_truth/pose", "/estimate"
NS_PER_S = 10**9
GAP_S = 0.5  # over a longer pause trajectory_error does not interpolate
LARGEST_DIFFERENCE = 0.01
HALF_DIGIT = {"RMSE": 0.0005, "median": 0.0005, "largest": 0.0005, "scale": 0.00005}


def read_poses(bag):
    """Stamps [ns] and positions of the true poses."""
    stamps, positions = [], []
    with Reader(bag) as reader:
        for connection, _, data in reader.messages():
            if connection.topic == TRUTH:
                pose = STORE.deserialize_ros1(data, POSE)
                stamps.append(pose.header.stamp.sec * NS_PER_S + pose.header.stamp.nanosec)
                positions.append([pose.pose.position.x, pose.pose.position.y, pose.pose.position.z])
    return numpy.array(stamps), numpy.array(positions)


def write_poses(bag, topics):
    header = STORE.types["std_msgs/msg/Header"]
    time = STORE.types["builtin_interfaces/msg/Time"]
    point, quaternion = STORE.types["geometry_msgs/msg/Point"], STORE.types["geometry_msgs/msg/Quaternion"]
    pose, stamped = STORE.types["geometry_msgs/msg/Pose"], STORE.types[POSE]
    with Writer(bag) as writer:
        for topic, (stamps, positions) in topics.items():
            connection = writer.add_connection(topic, POSE, typestore=STORE)
            for t, at in zip(stamps.tolist(), positions.tolist()):
                message = stamped(header(0, time(t // NS_PER_S, t % NS_PER_S), "world"),
                                  pose(point(*at), quaternion(0.0, 0.0, 0.0, 1.0)))
                writer.write(connection, t, STORE.serialize_ros1(message, POSE))


def interpolated(stamps, truth):
    """The truth at other instants; no numbers outside of it and in its pauses."""
    t_ns, positions = truth
    at = numpy.stack([numpy.interp(stamps - t_ns[0], t_ns - t_ns[0], axis) for axis in positions.T], axis=1)
    after = numpy.clip(numpy.searchsorted(t_ns, stamps), 1, len(t_ns) - 1)
    exact = numpy.isin(stamps, t_ns)
    covered = (stamps >= t_ns[0]) & (stamps <= t_ns[-1]) & (exact | (t_ns[after] - t_ns[after - 1] <= GAP_S * NS_PER_S))
    at[~covered] = numpy.nan
    return at


def estimate_of(truth, stamps, random, drift_m):
    """What an estimator might say: in a frame and scale of its own, with a drift and noise."""
    inside = numpy.clip(stamps, truth[0][0], truth[0][-1])
    positions = numpy.stack([numpy.interp(inside - truth[0][0], truth[0] - truth[0][0], axis)
                             for axis in truth[1].T], axis=1)
    walk = numpy.cumsum(random.normal(size=positions.shape), axis=0)
    positions = positions + drift_m * walk / numpy.abs(walk).max() + random.normal(0.0, 0.02, positions.shape)
    rotation, _ = numpy.linalg.qr(random.normal(size=(3, 3)))
    rotation *= numpy.sign(numpy.linalg.det(rotation))
    return positions @ rotation.T * random.uniform(0.8, 1.2) + random.normal(0.0, 3.0, 3)


def cases(truth, random):
    """Yields name, truth, estimate (each: stamps, positions)."""
    t_ns, positions = truth
    yield "same stamps", truth, (t_ns, estimate_of(truth, t_ns, random, 0.5))
    between = numpy.sort(random.integers(t_ns[0], t_ns[-1], len(t_ns) * 3 // 2))
    yield "between", truth, (between, estimate_of(truth, between, random, 0.3))
    middle = t_ns[len(t_ns) // 2]
    with_pause = numpy.abs(t_ns - middle) > NS_PER_S // 2
    more = numpy.sort(random.integers(t_ns[0] - NS_PER_S, t_ns[-1] + NS_PER_S, len(t_ns) * 3 // 2))
    estimate = estimate_of(truth, more, random, 1.0)
    estimate[random.integers(0, len(more), 5)] = numpy.nan
    yield "left out", (t_ns[with_pause], positions[with_pause]), (more, estimate)


def trajectory(stamps, positions):
    turned = numpy.tile([1.0, 0.0, 0.0, 0.0], (len(stamps), 1))
    return PoseTrajectory3D(positions_xyz=positions, orientations_quat_wxyz=turned, timestamps=stamps / NS_PER_S)


def aligned_by_yaw(estimate, truth):
    """The estimate turned about z and moved, so that the least remains."""
    centred = estimate - estimate.mean(axis=0)

    def turned(yaw):
        c, s = numpy.cos(yaw), numpy.sin(yaw)
        return centred @ numpy.array([[c, s, 0.0], [-s, c, 0.0], [0.0, 0.0, 1.0]]) + truth.mean(axis=0)

    def remains(yaw):
        return ((turned(yaw) - truth) ** 2).sum()

    start = min(numpy.linspace(-numpy.pi, numpy.pi, 73), key=remains)
    return turned(minimize_scalar(remains, bracket=(start - 0.1, start, start + 0.1), tol=1e-12).x)


def by_evo(true, guess, alignment):
    """RMSE, median, largest distance [m] and scale by evo."""
    scale = 1.0
    if alignment == "yaw":
        guess = trajectory(guess.timestamps * NS_PER_S, aligned_by_yaw(guess.positions_xyz, true.positions_xyz))
    else:
        scale = guess.align(true, correct_scale=alignment == "sim3")[2]
    error = metrics.APE(metrics.PoseRelation.translation_part)
    error.process_data((true, guess))
    kinds = metrics.StatisticsType
    return {"RMSE": error.get_statistic(kinds.rmse), "median": error.get_statistic(kinds.median),
            "largest": error.get_statistic(kinds.max), "scale": scale}


def by_trajectory_error(tools, bag, alignment):
    text = subprocess.run([str(tools / "trajectory_error"), bag, "--estimate", ESTIMATE, "--align", alignment],
                          stdout=subprocess.PIPE, text=True, check=True).stdout
    number = r"([-+.\d]+)"
    found = {"RMSE": re.search(r"RMSE \[m\]: *" + number, text), "median": re.search(r"median.*: *" + number, text),
             "largest": re.search(r"largest.*, " + number, text), "scale": re.search(r"scale: *" + number, text)}
    left_out = re.search(r"left out: *\d+, (\d+)", text)
    return {name: float(match.group(1)) if match else 1.0 for name, match in found.items()}, int(left_out.group(1))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--tools", type=pathlib.Path, default=ROOT / "devel" / "lib" / "fast_edi",
                        help="where simulate_davis and trajectory_error are (devel/lib/fast_edi)")
    parser.add_argument("--seeds", type=int, default=2, help="rooms, from seed 1 on")
    arguments = parser.parse_args()
    faults = []
    print("| room | estimates | align | RMSE [m]: trajectory_error | evo | largest difference of a figure | left out "
          "| evo on nearest poses |\n|---|---|---|---:|---:|---:|---:|---:|")
    with tempfile.TemporaryDirectory() as folder:
        for seed in range(1, arguments.seeds + 1):
            # Poses alone are wanted, so a small sensor.
            room = pathlib.Path(folder) / f"room_{seed}.bag"
            subprocess.run([str(arguments.tools / "simulate_davis"), "--out", room, "--scene", "room", "--seed",
                            str(seed), "--frames", "500", "--width", "48", "--height", "36"],
                           stdout=subprocess.DEVNULL, check=True)
            random = numpy.random.default_rng(seed)
            for name, truth, estimate in cases(read_poses(room), random):
                bag = pathlib.Path(folder) / f"{seed}_{name.replace(' ', '_')}.bag"
                write_poses(bag, {TRUTH: truth, ESTIMATE: estimate})
                at = interpolated(estimate[0], truth)
                kept = numpy.isfinite(at).all(axis=1) & numpy.isfinite(estimate[1]).all(axis=1)
                for alignment in ("yaw", "se3", "sim3"):
                    ours, left_out = by_trajectory_error(arguments.tools, bag, alignment)
                    guess = trajectory(estimate[0][kept], estimate[1][kept])
                    theirs = by_evo(trajectory(estimate[0][kept], at[kept]), guess, alignment)
                    nearest = sync.associate_trajectories(trajectory(*truth),
                                                          trajectory(estimate[0][kept], estimate[1][kept]),
                                                          max_diff=0.01)
                    differences = {figure: abs(ours[figure] / theirs[figure] - 1.0) for figure in ours}
                    print(f"| {seed} | {name} | {alignment} | {ours['RMSE']:.3f} | {theirs['RMSE']:.4f} | "
                          f"{100 * max(differences.values()):.2f} % | {left_out} | "
                          f"{by_evo(*nearest, alignment)['RMSE']:.4f} |")
                    faults += [f"room {seed}, {name}, {alignment}: {figure} {ours[figure]}, evo {theirs[figure]}"
                               for figure in ours if abs(ours[figure] - theirs[figure]) >
                               LARGEST_DIFFERENCE * theirs[figure] + HALF_DIGIT[figure]]
                    if left_out != numpy.count_nonzero(~kept):
                        faults.append(f"room {seed}, {name}: {left_out} left out, expected "
                                      f"{numpy.count_nonzero(~kept)}")
    print("\n".join(faults) or "all within 1 %")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
