#pragma once

#include <weave/design/design.hpp>

#include <string>
#include <string_view>
#include <vector>

namespace weave {

/// A design that is shipped with the program.
struct Sample {
    std::string name;  ///< lower case with hyphens
    std::string title;
    std::string about;  ///< what it shows, and whether the paper prints the pattern or it was built from its
                        ///< description
    std::string loom;   ///< the shipped profile on which it validates without errors, such as `tc2`
    Design (*make)();
};

/// The sample library, simplest first.
const std::vector<Sample>& samples();
/// Null if there is none of this name.
const Sample* find_sample(std::string_view name);

}  // namespace weave
