# What building, running and testing needs beyond a bare system, for launch/demo and test/run.
#
#   . launch/dependencies.bash
#   fast_edi_prepare            # to build and run
#   fast_edi_prepare test       # to run the tests and style checks as well
#
# Puts /usr/bin first in PATH (another python3 in front of the system's breaks catkin), installs the
# missing system packages (as root, or by sudo) and sources ROS where it lies in /opt/ros.
# Debian 12 carries ROS itself; Ubuntu 20.04 takes it from the ROS Noetic packages.

FAST_EDI_NOETIC=/opt/ros/noetic

# Packages of Debian 12.
FAST_EDI_DEBIAN_BUILD=(
  g++ make cmake catkin
  libroscpp-dev libroslib-dev libnodeletlib-dev libcv-bridge-dev libimage-transport-dev librosbag-dev
  libdynamic-reconfigure-config-init-mutex-dev python3-dynamic-reconfigure libdiagnostic-updater-dev
  libgeometry-msgs-dev libnav-msgs-dev libstd-srvs-dev
  libboost-program-options-dev libeigen3-dev libopencv-dev libopencv-contrib-dev libyaml-cpp-dev
  libvisualization-msgs-dev libapriltag-dev libbz2-dev liblz4-dev libzstd-dev libtinyxml2-dev libsqlite3-dev
  libhdf5-dev libzip-dev zlib1g-dev
  libdlib-dev libblas-dev liblapack-dev libsvm-dev
  pybind11-dev python3-dev python3-numpy
)
FAST_EDI_DEBIAN_RUN=(
  libnodeletlib-tools python3-roslaunch python3-rosbag python3-rostopic python3-sensor-msgs
  python3-diagnostic-msgs rosbash opencv-data
)
FAST_EDI_DEBIAN_TEST=(
  python3-rostest libgtest-dev libgmock-dev catkin-lint clang-tidy clang-format doxygen libxml2-utils
  shellcheck
  clang
  python3-pytest python3-pil python3-matplotlib mypy
  python3-venv python3-rospy
  xvfb xdotool locales
)
# Before Debian 12 this comes with clang.
FAST_EDI_DEBIAN_12_TEST=(libclang-rt-dev)

# The same on Ubuntu 20.04 with the ROS Noetic packages.
FAST_EDI_NOETIC_BUILD=(
  g++ make cmake ros-noetic-catkin
  ros-noetic-roscpp ros-noetic-roslib ros-noetic-nodelet ros-noetic-cv-bridge ros-noetic-image-transport
  ros-noetic-rosbag ros-noetic-dynamic-reconfigure ros-noetic-diagnostic-updater
  ros-noetic-geometry-msgs ros-noetic-nav-msgs ros-noetic-std-srvs
  ros-noetic-pluginlib ros-noetic-sensor-msgs ros-noetic-std-msgs ros-noetic-visualization-msgs ros-noetic-apriltag
  libboost-program-options-dev libeigen3-dev libopencv-dev libopencv-contrib-dev libyaml-cpp-dev
  libbz2-dev liblz4-dev libzstd-dev libtinyxml2-dev libsqlite3-dev libhdf5-dev libzip-dev zlib1g-dev
  libdlib-dev libblas-dev liblapack-dev libsvm-dev
  pybind11-dev python3-dev python3-numpy
)
FAST_EDI_NOETIC_RUN=(
  ros-noetic-roslaunch ros-noetic-rostopic ros-noetic-rosbash ros-noetic-diagnostic-msgs
)
FAST_EDI_NOETIC_TEST=(
  ros-noetic-rostest libgtest-dev libgmock-dev python3-catkin-lint clang-tidy clang-format doxygen
  libxml2-utils shellcheck
  clang
  python3-pytest python3-pil python3-matplotlib mypy
  python3-venv ros-noetic-rospy
  xvfb xdotool locales
)

# fast_edi_heed_interrupts SCRIPT [ARGUMENT...]: restarts a script where SIGINT is ignored, as it is
# for what a shell runs in the background. ROS ends processes by SIGINT, and those in Python would go
# on ignoring it. A shell cannot undo that itself.
fast_edi_heed_interrupts() {
  if [[ "$(trap -p INT)" == "trap -- '' "* ]]; then
    # shellcheck disable=SC2016
    exec perl -e '$SIG{INT} = "DEFAULT"; exec { $ARGV[0] } @ARGV or die "$ARGV[0]: $!\n"' -- "$@"
  fi
}

# Runs a command as root. Asks for a password only where somebody can type one.
fast_edi_as_root() {
  if [ "$(id -u)" -eq 0 ]; then
    "$@"
  elif ! command -v sudo >/dev/null; then
    echo "fast_edi: not root and no sudo; please run as root: $*" >&2
    return 1
  elif [ -t 0 ] && [ "${CI:-}" != true ]; then
    sudo "$@"
  else
    sudo -n "$@"
  fi
}

# Those of the packages that are not installed.
fast_edi_missing_packages() {
  local package
  for package in "$@"; do
    case "$(dpkg-query -W -f='${db:Status-Status}' "$package" 2>/dev/null)" in
      installed) ;;
      *) echo "$package" ;;
    esac
  done
}

# Installs those of the packages that are missing; says which.
fast_edi_install() {
  local missing
  mapfile -t missing < <(fast_edi_missing_packages "$@")
  if [ "${#missing[@]}" -eq 0 ]; then
    echo "fast_edi: all $# system packages needed are installed"
    return 0
  fi
  if ! command -v apt-get >/dev/null; then
    echo "fast_edi: no apt-get here; please install what corresponds to: ${missing[*]}" >&2
    return 1
  fi
  echo "fast_edi: installing ${#missing[@]} of $# system packages: ${missing[*]}"
  # A package source that cannot be reached matters only if the installation fails.
  fast_edi_as_root apt-get -q update ||
    echo "fast_edi: apt-get update failed, going on with the package lists as they are" >&2
  fast_edi_as_root env DEBIAN_FRONTEND=noninteractive \
    apt-get -q install -y --no-install-recommends "${missing[@]}" </dev/null
}

# fast_edi_debian_version [OS_RELEASE_FILE]: its number; large for those that have none (testing, sid).
fast_edi_debian_version() {
  local version
  version=$(sed -n 's/^VERSION_ID="\{0,1\}\([0-9]*\).*/\1/p' "${1:-/etc/os-release}")
  echo "${version:-1000}"
}

# fast_edi_packages [test [OS_RELEASE_FILE]]: what is needed, one on each line.
fast_edi_packages() {
  local packages
  if [ -d "$FAST_EDI_NOETIC" ]; then
    packages=("${FAST_EDI_NOETIC_BUILD[@]}" "${FAST_EDI_NOETIC_RUN[@]}")
    [ "${1:-}" = test ] && packages+=("${FAST_EDI_NOETIC_TEST[@]}")
  else
    packages=("${FAST_EDI_DEBIAN_BUILD[@]}" "${FAST_EDI_DEBIAN_RUN[@]}")
    if [ "${1:-}" = test ]; then
      packages+=("${FAST_EDI_DEBIAN_TEST[@]}")
      [ "$(fast_edi_debian_version "${2:-}")" -lt 12 ] || packages+=("${FAST_EDI_DEBIAN_12_TEST[@]}")
    fi
  fi
  printf '%s\n' "${packages[@]}"
}

# fast_edi_prepare [test]
fast_edi_prepare() {
  export PATH="/usr/bin:$PATH"
  local packages
  mapfile -t packages < <(fast_edi_packages "$@")
  fast_edi_install "${packages[@]}" || return 1
  if [ -d "$FAST_EDI_NOETIC" ]; then
    fast_edi_source "$FAST_EDI_NOETIC/setup.bash"
  fi
}

# Sources a setup file of catkin's, which trips over `set -e` and `set -u`.
fast_edi_source() {
  local options=$-
  set +eu
  # shellcheck disable=SC1090
  . "$1"
  [[ $options == *e* ]] && set -e
  [[ $options == *u* ]] && set -u
  return 0
}

# How launch/demo and test/run configure build/: alike, so that neither builds again what the other has
# built. Tests are built by the target `tests` alone. Without the packages that they need, CMake says
# so and leaves them out. Several sources of a library are compiled in one, in half the time.
# shellcheck disable=SC2034
FAST_EDI_OPTIONS=(
  -DCMAKE_BUILD_TYPE=Release -DCATKIN_ENABLE_TESTING=ON -DFAST_EDI_WARNINGS_AS_ERRORS=ON
  -DCMAKE_UNITY_BUILD=ON
)

# fast_edi_make BUILD_FOLDER [TARGET ...]
fast_edi_make() {
  make --no-print-directory --quiet -j"$(nproc)" -C "$@"
}

# fast_edi_refuse_folder FOLDER: says why the package cannot be built there, if it cannot.
fast_edi_refuse_folder() {
  local taken=$'[]["\'`$\\\\;:#%&<>|*?!(){}\t\n]'
  # shellcheck disable=SC2254
  case $1 in
    *$taken*)
      echo "fast_edi: make, catkin or ROS take apart the name of the folder $1: expected none of the" \
        "characters \" ' \` \$ \\ ; : # % & < > | * ? ! ( ) { } [ ] in it" >&2
      return 1
      ;;
  esac
}

# fast_edi_configure BUILD_FOLDER [CMake option ...]: configures the package in a build folder of
# its own.
fast_edi_configure() {
  local build=$1
  shift
  cmake -S "$(dirname "${BASH_SOURCE[0]}")/.." -B "$build" "$@"
}

# fast_edi_build_package BUILD_FOLDER: builds what the demo needs. What test/run has built there counts,
# and the other way round. Needs `set -o pipefail`.
fast_edi_build_package() {
  local log=$1/build.log
  [ -f "$1/Makefile" ] || fast_edi_configure "$1" "${FAST_EDI_OPTIONS[@]}" >/dev/null
  if ! fast_edi_make "$1" 2>&1 | tee "$log"; then
    # A compiler that warns where those that the package is tried with do not.
    grep -q -e '-Werror' "$log" || return 1
    echo "== building again, without taking warnings for errors"
    fast_edi_configure "$1" -DFAST_EDI_WARNINGS_AS_ERRORS=OFF >/dev/null
    fast_edi_make "$1"
  fi
}
