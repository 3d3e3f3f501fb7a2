#pragma once

#include <weave/design/edit.hpp>

#include <QString>

#include <vector>

namespace weave::studio {

/// What a person does at once, and undoes at once: edits of the design, made in their order.
struct EditStep {
    QString text;             ///< as the undo menu has it, such as `Flip pick 3, end 7`
    std::vector<Edit> edits;  ///< none: nothing happens
    /// A step with the key of the one before it, which nothing came between, takes its place, as while a slider is drawn.
    /// It sets all that the other has set. Empty: stays by itself.
    QString key = {};
};

}  // namespace weave::studio
