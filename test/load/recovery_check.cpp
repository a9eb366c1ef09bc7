// Whether a node of another process works as a new one does. Arguments: its namespace, its name.

#include <cstdlib>
#include <iostream>

#include <ros/init.h>

#include "load/recovery.hpp"

int main(int argc, char** argv) {
  ros::init(argc, argv, "recovery_check", ros::init_options::AnonymousName);
  if (argc != 3) {
    std::cerr << "recovery_check NAMESPACE NODE\n";
    return EXIT_FAILURE;
  }
  const std::string fault = fast_edi::load::faultAfterLoad(argv[1], argv[2]);
  if (!fault.empty()) {
    std::cerr << fault << "\n";
    return EXIT_FAILURE;
  }
  return EXIT_SUCCESS;
}
