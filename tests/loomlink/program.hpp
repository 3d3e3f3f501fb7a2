#pragma once

#include <string>
#include <support/program.hpp>
#include <utility>
#include <vector>

namespace weave::loomlink::testing {

/// The program `loomlink`.
class Program : public weave::testing::Program {
  public:
    Program(std::vector<std::string> words, const std::string& told) : weave::testing::Program("loomlink", std::move(words), told) {}
};

}  // namespace weave::loomlink::testing
