/// \file
/// The dynamic_reconfigure server of a node: the service `set_parameters` and what belongs to it,
/// in front of LiveParameters.
#pragma once

#include <functional>
#include <memory>

#include <ros/node_handle.h>

#include "fast_edi/config/live_parameters.hpp"

namespace fast_edi {

/// Values out of range reach the handler, which refuses them; the library's own server would move
/// them into their range and say nothing. The reply, the topic `parameter_updates` and the
/// parameter server show what is in force after each request. The parameter server has no contrast
/// threshold while it comes from biases: a later start with 0 would be refused.
///
/// Threads. Requests are answered in the thread of the node handle's queue: let that be a
/// CallbackThread, so that events need not wait for the parameter server, and stop it before
/// destroying this object, which the library's server does not survive while it answers a request.
class ReconfigureServer {
 public:
  /// \param wanted values that differ from those in force
  /// \return all values in force afterwards
  using Handler = std::function<LiveParameters::Values(const LiveParameters::Values& wanted)>;

  /// \param private_nh of the node, with the queue for requests
  /// \param in_force all live parameters; the handler is not called with them
  ReconfigureServer(const ros::NodeHandle& private_nh, const LiveParameters::Values& in_force,
                    Handler handler);
  ~ReconfigureServer();
  ReconfigureServer(const ReconfigureServer&) = delete;
  ReconfigureServer& operator=(const ReconfigureServer&) = delete;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace fast_edi
