/// \file
/// `deblur_bag`: a recording in, the same recording with deblurred frames out, or a film of it.

#include "command_line.hpp"
#include "interruption.hpp"
#include "tools/deblur_bag/deblur_bag_arguments.hpp"
#include "tools/deblur_bag/deblur_recording.hpp"
#include "tools/deblur_bag/deblur_recordings.hpp"

namespace {

namespace deblur_bag = fast_edi::deblur_bag;

int run(const deblur_bag::Arguments& arguments) {
  return arguments.output_folder.empty() ? deblur_bag::deblurRecording(arguments).exit_code
                                         : deblur_bag::deblurRecordings(arguments);
}

}  // namespace

int main(int argc, char** argv) {
  fast_edi::tools::handleSignals();
  return fast_edi::tools::runTool("deblur_bag", [argc, argv] {
    deblur_bag::Arguments arguments;
    return deblur_bag::parseArguments(argc, argv, arguments) ? run(arguments)
                                                             : fast_edi::tools::kDone;
  });
}
