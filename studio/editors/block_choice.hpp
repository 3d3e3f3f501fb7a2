#pragma once

#include <QPixmap>
#include <QString>

#include <cstdint>
#include <vector>

namespace weave::studio {

/// A block of the design that an operation may take, as its owner knows it.
struct BlockChoice {
    QString name;
    QPixmap thumbnail;
    std::vector<std::uint32_t> t,
        p;           ///< picks of its rows, ends of its columns; empty where it cannot be made
    QString reason;  ///< why it cannot be used at all, such as a cycle; empty where it can
};

}  // namespace weave::studio
