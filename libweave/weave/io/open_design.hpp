#pragma once

#include <weave/design/design.hpp>

#include <filesystem>
#include <string>
#include <vector>

namespace weave {

/// A design from any file that one can be made of.
struct OpenedDesign {
    Design design;
    bool is_document = true;            ///< it was a `.weave` document; else it was made from another kind of file
    std::vector<std::string> warnings;  ///< what was odd about the file
};

/// Reads a `.weave` document, a WIF file or a picture of a card (PNG, TIFF, BMP), known by what is in it. A picture's picks and
/// ends are taken to lie side by side (t = p = 1), black as lifted, pick 1 at the bottom. Errors name the file; of a loom
/// controller's file they say how it is read.
Result<OpenedDesign> open_design(const std::filesystem::path& path);

/// A card as a design of one block, its picks and ends side by side.
Design design_of_card(CardImage card);

}  // namespace weave
