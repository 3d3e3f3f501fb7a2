#pragma once

#include <weave/block/operations.hpp>
#include <weave/design/design.hpp>

#include <QMenu>

#include <functional>
#include <string>

namespace weave::studio {

/// Where a face of a block is, in a weaver's words: `after the last pick`, `below`.
QString face_words(Face face);

/// Fills a menu with the blocks that can be attached to this face of a block, and those that cannot, each with the reason beside it.
void offer_blocks(QMenu& menu, const Design& design, const std::string& block, Face face, const std::function<void(const std::string& other)>& chosen);

/// Fills a menu with the faces to which one block can be attached.
void offer_faces(QMenu& menu, const Design& design, const std::string& block, const std::string& other, const std::function<void(Face face)>& chosen);

}  // namespace weave::studio
