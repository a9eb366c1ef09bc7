/// Prints when each event array of a topic arrived, for test/peers/live_latency.py:
///
///     array_arrivals TOPIC
///
/// One line for each: seconds of the steady clock when decoding of the message began, and the time
/// of its last event [us]. Ends with SIGINT.
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <vector>

#include <ros/ros.h>

#include "fast_edi/base/types.hpp"
#include "fast_edi/events/event_wire.hpp"
#include "fast_edi/messages/event_array.hpp"

namespace {

constexpr int kQueue = 10'000;

struct Arrival {
  std::int64_t at_ns;
  std::int64_t last_event_ns;
};

}  // namespace

int main(int argc, char** argv) {
  ros::init(argc, argv, "array_arrivals", ros::init_options::NoRosout);
  if (argc != 2) {
    std::fprintf(stderr, "array_arrivals: expected one topic\n");
    return EXIT_FAILURE;
  }
  std::vector<Arrival> arrivals;  // printed at the end: writing would delay those that follow
  ros::NodeHandle nh;
  const auto subscriber = nh.subscribe<fast_edi::EventArray>(
      argv[1], kQueue,
      [&arrivals](const fast_edi::EventArray::ConstPtr& array) {
        const fast_edi::WireEvents events = array->events();
        if (!events.empty()) {
          const fast_edi::Event last = fast_edi::decodeWireEvent(events.record(events.count - 1));
          arrivals.push_back({array->decodingSince(), last.t_ns});
        }
      },
      {}, ros::TransportHints().tcpNoDelay());
  ros::spin();
  for (const Arrival& arrival : arrivals) {
    std::printf("%.6f %lld\n", static_cast<double>(arrival.at_ns) * 1e-9,
                static_cast<long long>((arrival.last_event_ns + 500) / 1000));
  }
  return EXIT_SUCCESS;
}
