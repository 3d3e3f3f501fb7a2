#pragma once

#include <weave/core/result.hpp>
#include <weave/sim/inspect.hpp>
#include <weave/sim/yarns.hpp>

#include <QObject>
#include <QString>

#include <cstdint>
#include <functional>
#include <memory>

namespace weave::studio {

/// Writes and reads relaxed yarns in a thread of its own.
class YarnsFiles : public QObject {
    Q_OBJECT
  public:
    explicit YarnsFiles(QObject* parent = nullptr) : QObject(parent) {}

    /// Writes what the file's name ends in: .yarns, .vtp (ParaView) or .obj.
    void write(std::shared_ptr<const Yarns> yarns, const QString& file);
    void read(const QString& file);
    /// Nobody wants what is being read any more.
    void forget() { ++m_wanted; }

  Q_SIGNALS:
    void written(const QString& file);
    void was_read(const std::shared_ptr<const weave::Yarns>& yarns,
                  const std::shared_ptr<const weave::Inspection>& inspection);
    void failed(const weave::Error& error);

  private:
    void begin(std::function<std::function<void(YarnsFiles&)>()> work);

    std::uint64_t m_wanted = 0;
};

}  // namespace weave::studio
