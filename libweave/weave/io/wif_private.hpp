#pragma once

#include <weave/design/design.hpp>
#include <weave/io/wif_lexer.hpp>

namespace weave::wif {

/// Our own section, with its header: t and p, and whatever of title, notes and yarn plans WIF cannot hold, as
/// JSON in short pieces. `before` is the whole file up to here; its hash lets a reader see whether another
/// program has changed the file since.
std::string private_section(const Design& design, const Block& block, const CardImage& card,
                            std::string_view before);

/// Puts into `design`, whose root is a CardLeaf of `card`, what our section says: t and p where the card is
/// still the one that was written, and all the rest where the whole file is. Otherwise warns and leaves the
/// design as it is. Errors: a section of ours that no program of ours wrote.
Status apply_private(std::string_view text, const File& file, Design& design, Warnings& warnings);

}  // namespace weave::wif
