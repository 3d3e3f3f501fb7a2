#include <studio/window/recent_designs.hpp>

#include <QCryptographicHash>
#include <QDir>
#include <QFileInfo>
#include <QSaveFile>
#include <QSettings>
#include <QStandardPaths>

namespace weave::studio::recent_designs {

namespace {

constexpr int most = 12;

/// Of a path, as settings and files may be named.
QString name_of(const QString& path) {
    return QString::fromLatin1(QCryptographicHash::hash(QFileInfo(path).absoluteFilePath().toUtf8(), QCryptographicHash::Sha1).toHex());
}

QString view_key(const QString& path) {
    return "views/" + name_of(path);
}

QDir pictures() {
    return QDir(QStandardPaths::writableLocation(QStandardPaths::CacheLocation) + "/recent");
}

QString picture_name(const QString& path) {
    return name_of(path) + ".png";
}

void set_paths(QStringList all) {
    QSettings settings;
    while (all.size() > most) settings.remove(view_key(all.takeLast()));
    settings.setValue("recent", all);
}

}  // namespace

QStringList paths() {
    return QSettings().value("recent").toStringList();
}

void note(const QString& path) {
    QStringList all = paths();
    const QString whole = QFileInfo(path).absoluteFilePath();
    all.removeAll(whole);
    all.prepend(whole);
    set_paths(all);
}

void forget(const QString& path) {
    QStringList all = paths();
    all.removeAll(path);
    set_paths(all);
    QSettings().remove(view_key(path));
    pictures().remove(picture_name(path));
}

void keep_view(const QString& path, const Json& view) {
    if (paths().contains(QFileInfo(path).absoluteFilePath())) QSettings().setValue(view_key(path), QString::fromStdString(view.dump()));
}

Json view(const QString& path) {
    const auto read = parse_json(QSettings().value(view_key(path)).toString().toStdString());
    return read && read->is_object() ? *read : Json::object();
}

void keep_picture(const QString& path, const QImage& picture) {
    const QDir folder = pictures();
    if (!folder.mkpath(".")) return;
    QSaveFile file(folder.filePath(picture_name(path)));
    if (file.open(QIODevice::WriteOnly) && picture.save(&file, "PNG")) file.commit();
    QStringList kept;
    for (const QString& each : paths()) kept.push_back(picture_name(each));
    for (const QString& there : folder.entryList({"*.png"}, QDir::Files)) {
        if (!kept.contains(there)) QFile::remove(folder.filePath(there));
    }
}

QImage picture(const QString& path) {
    return QImage(pictures().filePath(picture_name(path)));
}

}  // namespace weave::studio::recent_designs
