#include "tools/evaluate/evaluate_text.hpp"

#include <iomanip>
#include <iostream>
#include <sstream>

namespace fast_edi::evaluate {

std::string decimal(double value) {
  std::ostringstream text;
  text << std::setprecision(4) << value;
  return text.str();
}

std::vector<std::string> notesOf(const FrameScorer& scorer) {
  std::vector<std::string> notes;
  for (const std::string& missing : scorer.missing()) {
    notes.push_back("Not measured: " + missing);
  }
  return notes;
}

void printGroups(const std::vector<EvaluationGroup>& groups,
                 const std::vector<std::string>& notes) {
  EvaluationGroup all{"all", {}};
  for (const EvaluationGroup& group : groups) {
    std::cout << group.name << "\n\n";
    if (group.members.size() > 1) {
      for (const Measure measure : {Measure::kPsnr, Measure::kSsim}) {
        std::cout << describe(measure).name << "\n";
        printMemberTable(std::cout, group, measure);
        std::cout << "\n";
      }
    }
    printMeasureTable(std::cout, group);
    std::cout << "\n";
    all.members.insert(all.members.end(), group.members.begin(), group.members.end());
  }
  printRuntimeTable(std::cout, all);
  std::cout << "\n";
  for (const std::string& note : notes) {
    std::cout << note << "\n";
  }
}

}  // namespace fast_edi::evaluate
