#include "tools/deblur_bag/deblur_outputs.hpp"

#include <filesystem>
#include <iostream>
#include <map>
#include <stdexcept>
#include <string>
#include <utility>

#include "command_line.hpp"

namespace fast_edi::deblur_bag {
namespace {

void printFilm(const FilmReport& film, const std::string& path) {
  std::cout << "film: " << film.images << " images";
  if (film.held > 0) {
    std::cout << ", " << film.held << " of them held for want of a latent image";
  }
  if (film.cuts > 0) {
    std::cout << ", " << film.cuts << " cuts where time jumps";
  }
  if (film.left_out > 0) {
    std::cout << ", " << film.left_out << " images of another size or encoding left out";
  }
  std::cout << "\nwritten: " << path << "\n";
}

/// \throws std::runtime_error when two options name the same output
void refuseSharedOutputs(const Arguments& arguments) {
  std::map<std::filesystem::path, std::string> options;
  const std::pair<const char*, const std::string&> outputs[] = {
      {"--out", arguments.output},
      {"--video", arguments.video},
      {"--frames", arguments.frames},
      {"--trust", arguments.trust},
      {"--save-learned", arguments.save_learned}};
  for (const auto& [option, path] : outputs) {
    if (path.empty()) {
      continue;
    }
    const auto [entry, is_new] = options.emplace(std::filesystem::weakly_canonical(path), option);
    if (!is_new) {
      throw std::runtime_error("cannot write " + path + ": both " + entry->second + " and " +
                               option + " name it");
    }
  }
}

/// A deblurred frame, or one that was passed through; its exposure where that is known.
void addTo(FrameFolder& folder, const sensor_msgs::Image& image, const OutputFrame& frame) {
  const ExposureInterval& exposure = frame.exposure;
  folder.add(image, exposure.length() > 0 ? std::optional(exposure) : std::nullopt);
}

}  // namespace

DeblurOutputs::DeblurOutputs(const Arguments& arguments, const std::string& compression)
    : arguments_(arguments) {
  refuseSharedOutputs(arguments);
  const bool overwrite = arguments.overwrite;
  if (!arguments.video.empty()) {
    film_.emplace(arguments.video, arguments.film_rate_hz, overwrite);
  }
  if (!arguments.frames.empty()) {
    folder_.emplace(arguments.frames, overwrite);
  }
  if (!arguments.trust.empty()) {
    trust_.emplace(arguments.trust, overwrite);
  }
  if (!arguments.save_learned.empty()) {
    tools::refuseInput(arguments.save_learned, arguments.inputs);
    tools::requireFree(arguments.save_learned, overwrite);
    learned_.emplace(arguments.save_learned);
  }
  if (!arguments.output.empty()) {
    const bool is_one_of_many = !arguments.output_folder.empty();
    bag_.emplace(arguments.output, arguments.inputs, compression, overwrite,
                 is_one_of_many ? UnfinishedBag::kRemove : UnfinishedBag::kKeep);
  }
}

void DeblurOutputs::add(const BagPipeline::Output& output) {
  if (folder_) {
    addTo(*folder_, *output.image, output.frame);
  }
  if (trust_) {
    addTo(*trust_, *output.trust, output.frame);
  }
  if (film_) {
    film_->addFrame(*output.image);
    for (const sensor_msgs::ImagePtr& latent : output.latent) {
      film_->addLatent(*latent);
    }
  }
}

void DeblurOutputs::close(const BagDeblurReport& report) {
  if (bag_) {
    bag_->close();
  }
  if (learned_ && report.learned_pairs > 0) {
    learned_->write(report.thresholds, report.event_delay_ns);
    is_learned_written_ = true;
  }
  if (film_) {
    film_->close();
  }
  if (folder_) {
    folder_->close();
  }
  if (trust_) {
    trust_->close();
  }
}

void DeblurOutputs::print() const {
  if (bag_) {
    std::cout << "written: " << arguments_.output << "\n";
  }
  if (is_learned_written_) {
    std::cout << "written: " << arguments_.save_learned << "\n";
  }
  if (film_) {
    printFilm(film_->report(), arguments_.video);
  }
  if (folder_) {
    std::cout << "written: " << folder_->frames() << " frames to " << arguments_.frames << "\n";
  }
  if (trust_) {
    std::cout << "written: " << trust_->frames() << " maps of trust to " << arguments_.trust
              << "\n";
  }
  std::cout << std::flush;
}

bool DeblurOutputs::reportLeftOut() const {
  if (learned_ && !is_learned_written_) {
    std::cerr
        << "warning: not written: " << arguments_.save_learned
        << ": nothing was learned. Expected: filter, and refine_contrast or refine_delay, are "
           "on, and consecutive frames with motion are deblurred\n";
  }
  if (!folder_ || folder_->leftOut() == 0) {
    return true;
  }
  std::cerr << "warning: " << folder_->leftOut() << " frames that PNG cannot hold left out of "
            << arguments_.frames << "\n";
  return false;
}

}  // namespace fast_edi::deblur_bag
