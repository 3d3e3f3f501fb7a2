#pragma once

#include <weave/design/outline.hpp>

#include <QObject>
#include <QString>

#include <optional>
#include <string>

namespace weave::studio {

/// What a person looks at: the block that all editors show, and a place in it. No edit changes it by itself; what is undone or
/// redone is seen in the block in which it was done.
class Focus : public QObject {
    Q_OBJECT
  public:
    using QObject::QObject;

    /// Name of the block that is shown.
    [[nodiscard]] const std::string& block() const { return m_block; }
    /// Crossing of that block to which editors go; none at first.
    [[nodiscard]] const std::optional<CardPlace>& place() const { return m_place; }

    void show_block(const std::string& block);
    /// Goes to a crossing of the block that is shown, pick and end from 0.
    void go_to(const CardPlace& place);

  Q_SIGNALS:
    void block_changed();
    void place_changed();

  private:
    std::string m_block;
    std::optional<CardPlace> m_place;
};

}  // namespace weave::studio
