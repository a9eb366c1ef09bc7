#include "bags/deblur_steps.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <vector>

#include <boost/make_shared.hpp>

namespace fast_edi {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

/// A made-up recording: each message is a number, each third one completes a frame with work left
/// to do, each fifth one without.
class Steps {
 public:
  explicit Steps(std::uint32_t messages, std::size_t message_bytes = 100)
      : messages_(messages), bytes_(message_bytes) {
    steps.stops = [this] { return asked_++ == stop_at; };
    steps.read = [this](ReadMessage& read) {
      if (next_ == fail_read_at) {
        throw std::runtime_error("cannot read");
      }
      if (next_ == messages_) {
        return false;
      }
      std::fill(bytes_.begin(), bytes_.end(), static_cast<std::uint8_t>(next_));
      read.message.connection = &connection_;
      read.message.time = ros::Time(next_ + 1, 0);
      read.message.data = bytes_.data();
      read.message.size = static_cast<std::uint32_t>(bytes_.size());
      read.position = next_;
      ++next_;
      under_way_ += read.message.size;
      most_under_way = std::max(most_under_way, under_way_.load());
      return true;
    };
    steps.copy = [this](const ReadMessage& read) {
      const std::uint32_t number = read.message.time.sec - 1;
      if (number == fail_write_at) {
        throw std::runtime_error("the disk is full");
      }
      const std::uint8_t* data = read.message.data;
      const bool is_whole = std::all_of(data, data + read.message.size, [&](std::uint8_t byte) {
        return byte == static_cast<std::uint8_t>(number);
      });
      written += (is_whole ? "m" : "damaged") + std::to_string(number) + " ";
      under_way_ -= read.message.size;
    };
    steps.integrate = [this](const BagMessage& message) {
      const std::uint32_t number = message.time.sec - 1;
      if (number == fail_integrate_at) {
        throw std::runtime_error("out of memory");
      }
      DeblurSteps::Outputs outputs;
      if (number % 3 == 0) {
        outputs.push_back(output(number, true));
      }
      if (number % 5 == 0) {
        outputs.push_back(output(number, false));
      }
      return outputs;
    };
    steps.finish = [this] {
      DeblurSteps::Outputs outputs;
      outputs.push_back(output(messages_, true));
      return outputs;
    };
    steps.write = [this](const BagPipeline::Output& out, const ros::Time& time) {
      written += out.image->encoding + "@" + std::to_string(time.sec - 1) + " ";
    };
  }

  std::string onThreads(std::size_t threads) {
    if (threads == 1) {
      deblurStepByStep(steps);
    } else {
      deblurOnThreads(steps, threads);
    }
    return written;
  }

  static constexpr std::uint32_t kNever = UINT32_MAX;
  DeblurSteps steps;
  std::uint32_t stop_at = kNever;
  std::uint32_t fail_read_at = kNever;
  std::uint32_t fail_integrate_at = kNever;
  std::uint32_t fail_filter_at = kNever;
  std::uint32_t fail_write_at = kNever;
  std::string written;
  std::size_t most_under_way = 0;

 private:
  BagPipeline::Output output(std::uint32_t number, bool works) const {
    BagPipeline::Output output;
    output.image = boost::make_shared<sensor_msgs::Image>();
    output.image->encoding = "p" + std::to_string(number);
    if (works) {
      output.work = [this, image = output.image, number](FrameRenderer&) {
        if (number == fail_filter_at) {
          throw std::runtime_error("no such filter");
        }
        image->encoding[0] = 'f';
        return false;
      };
    }
    return output;
  }

  const std::uint32_t messages_;
  std::vector<std::uint8_t> bytes_;
  BagConnection connection_;
  std::uint32_t next_ = 0;
  std::uint32_t asked_ = 0;
  std::atomic<std::size_t> under_way_{0};
};

TEST(DeblurSteps, WriteEachFrameBehindTheMessageThatCompletedIt) {
  EXPECT_EQ(Steps(7).onThreads(1), "m0 f0@0 p0@0 m1 m2 m3 f3@3 m4 m5 p5@5 m6 f6@6 f7@6 ");
}

class DeblurStepsOnThreads : public ::testing::TestWithParam<std::size_t> {
 protected:
  /// What is thrown.
  static std::string failureOf(Steps& steps) {
    try {
      steps.onThreads(GetParam());
    } catch (const std::runtime_error& error) {
      return error.what();
    }
    return "nothing";
  }
};
INSTANTIATE_TEST_SUITE_P(Threads, DeblurStepsOnThreads, ::testing::Values(2, 3, 8));

TEST_P(DeblurStepsOnThreads, WriteTheSameAsOnOneThread) {
  for (const std::uint32_t messages : {0u, 1u, 2u, 50u, 3000u}) {
    // Several messages go together, or each alone.
    for (const std::size_t bytes : {std::size_t{0}, std::size_t{100}, std::size_t{300'000}}) {
      if (messages * bytes < 50'000'000) {
        EXPECT_TRUE(Steps(messages, bytes).onThreads(GetParam()) ==
                    Steps(messages, bytes).onThreads(1))
            << messages << " messages of " << bytes << " bytes";
      }
    }
  }
}

TEST_P(DeblurStepsOnThreads, ThrowWhatAStepHasThrown) {
  constexpr std::uint32_t kMessages = 3000;
  constexpr std::uint32_t kBad = 1500;
  Steps integrate(kMessages);
  integrate.fail_integrate_at = kBad;
  EXPECT_EQ(failureOf(integrate), "out of memory");
  Steps filter(kMessages);
  filter.fail_filter_at = kBad;
  EXPECT_EQ(failureOf(filter), "no such filter");
  EXPECT_THAT(filter.written, Not(HasSubstr("f1500@")));
  Steps write(kMessages);
  write.fail_write_at = kBad;
  EXPECT_EQ(failureOf(write), "the disk is full");
  EXPECT_THAT(write.written, HasSubstr("m1499 "));
  EXPECT_THAT(write.written, Not(HasSubstr("m1500 ")));
}

TEST_P(DeblurStepsOnThreads, WriteAllThatCouldBeReadBeforeReadingFailed) {
  Steps steps(3000);
  steps.fail_read_at = 1500;
  EXPECT_EQ(failureOf(steps), "cannot read");
  EXPECT_THAT(steps.written, HasSubstr("m1499 "));
  EXPECT_THAT(steps.written, Not(HasSubstr("f3000")));
  Steps single(3000);
  single.fail_read_at = 1500;
  EXPECT_THROW(single.onThreads(1), std::runtime_error);
  EXPECT_TRUE(steps.written == single.written);
}

TEST_P(DeblurStepsOnThreads, EndWhereTheyAreStoppedWhateverWasRead) {
  for (const std::uint32_t stop_at : {0u, 1u, 1500u, 2999u}) {
    Steps one(3000);
    one.stop_at = stop_at;
    Steps more(3000);
    more.stop_at = stop_at;
    EXPECT_TRUE(more.onThreads(GetParam()) == one.onThreads(1)) << stop_at;
    EXPECT_THAT(more.written, HasSubstr("f3000@"));
    EXPECT_THAT(more.written, Not(HasSubstr("m" + std::to_string(stop_at) + " ")));
  }
}

TEST_P(DeblurStepsOnThreads, ReadNoFurtherAheadThanMemoryAllows) {
  constexpr std::size_t kPerThread = std::size_t{16} << 20;
  constexpr std::size_t kMessage = 1 << 20;
  const std::size_t most = 2 * (GetParam() * kPerThread + kMessage);
  Steps steps(static_cast<std::uint32_t>(most / kMessage * 3 / 2), kMessage);
  steps.onThreads(GetParam());
  EXPECT_LE(steps.most_under_way, most);
}

}  // namespace
}  // namespace fast_edi
