/// \file
/// ROS for the tests of one program.
#pragma once

namespace fast_edi {
namespace test {

/// Starts a master of the program's own and this process's node, once. Both stay until all tests
/// have run.
/// \throws std::runtime_error when the master does not start
void requireRos();

}  // namespace test
}  // namespace fast_edi
