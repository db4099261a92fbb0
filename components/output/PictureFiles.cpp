#include "components/output/PictureFiles.hpp"

#include <png.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>
#include <stdexcept>

#include "types/text/DidYouMean.hpp"

namespace insonify::output {
namespace {

constexpr FileFormat all_formats[] = {
    {".png", FileContent::Picture, writePng},
    {".avi", FileContent::Video, nullptr, "MJPG"},
    {".mp4", FileContent::Video, nullptr, "mp4v"},
    {".xtf", FileContent::SideScan},
};

}  // namespace

const FileFormat* findFileFormat(const std::filesystem::path& file, FileContent content) {
    const FileFormat* const format = types::findFormat(all_formats, file);
    return format && format->content == content ? format : nullptr;
}

std::string fileEndings(FileContent content) {
    return types::alternativeEndings(all_formats, [&](const FileFormat& format) { return format.content == content; });
}

std::optional<FilePattern> FilePattern::parse(const std::string& pattern) {
    const size_t percent = pattern.find('%');
    if (percent == pattern.npos || pattern.find('%', percent + 1) != pattern.npos) return {};
    const size_t letter = pattern.find_first_not_of("0123456789", percent + 1);
    const std::string flags = pattern.substr(percent + 1, letter - percent - 1);
    FilePattern parsed;
    parsed.format_ = findFileFormat(pattern, FileContent::Picture);
    if (letter == pattern.npos || pattern[letter] != 'd' || flags.size() > 3 || !parsed.format_) return {};
    parsed.before_ = pattern.substr(0, percent);
    parsed.after_ = pattern.substr(letter + 1);
    parsed.width_ = flags.empty() ? 0 : std::stoi(flags);
    parsed.filler_ = flags.starts_with('0') ? '0' : ' ';
    return parsed.width_ > 99 ? std::nullopt : std::optional(parsed);
}

std::string FilePattern::name(uint64_t number) const {
    std::string digits = std::to_string(number);
    digits.insert(0, static_cast<size_t>(std::max(0, width_ - static_cast<int>(digits.size()))), filler_);
    return before_ + digits + after_;
}

namespace {

struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }
};

[[noreturn]] void fail(const std::filesystem::path& file, const std::string& reason) {
    throw std::runtime_error("cannot write " + file.string() + ": " + reason);
}

/** Returns the format. Throws if the picture's mode is unknown, or its pixels do not match it. */
png_uint_32 pngFormat(const std::filesystem::path& file, const types::Image& picture) {
    const bool grey = picture.frame_mode == types::ImageMode::Grayscale;
    const bool rgb = picture.frame_mode == types::ImageMode::Rgb;
    const bool known = grey || rgb || picture.frame_mode == types::ImageMode::Bgr;
    if (!known || picture.pixel_size != (grey ? 1 : 3) || !picture.holdsPixels() || picture.image.empty())
        fail(file, "the picture is empty, or neither grey, RGB nor BGR of 8 bits a channel");
    return grey ? PNG_FORMAT_GRAY : rgb ? PNG_FORMAT_RGB : PNG_FORMAT_BGR;
}

}  // namespace

void DisplayConfig::check(types::Diagnostics& diagnostics) const {
    if (scale == BinScale::Code && reference_db)
        diagnostics.push_back(
            {"reference_db", "is given, but bins are codes; the brightest colour is the max code of code_bits"});
}

void RecordingConfig::check(types::Diagnostics& diagnostics) const {
    if (file && !FilePattern::parse(*file))
        diagnostics.push_back(
            {"file", "is '" + *file + "'; it must have one number and end in " + fileEndings(FileContent::Picture) +
                         ", as in fan_%06d.png" +
                         (findFileFormat(*file, FileContent::Video) ? "; `video` takes this one" : "")});
    if (video && !findFileFormat(*video, FileContent::Video))
        diagnostics.push_back({"video", "is '" + *video + "'; it must end in " + fileEndings(FileContent::Video)});
}

void writePng(const std::filesystem::path& file, const types::Image& picture) {
    png_image png{};
    png.version = PNG_IMAGE_VERSION;
    png.width = picture.size.width;
    png.height = picture.size.height;
    png.format = pngFormat(file, picture);
    png.flags = PNG_IMAGE_FLAG_FAST;
    errno = 0;
    const std::unique_ptr<std::FILE, Close> stream(std::fopen(file.c_str(), "wb"));
    if (!stream) fail(file, std::strerror(errno));
    const auto row_size = static_cast<png_int_32>(picture.row_size);
    if (png_image_write_to_stdio(&png, stream.get(), 0, picture.image.data(), row_size, nullptr) &&
        std::fflush(stream.get()) == 0)
        return;
    const std::string reason = errno ? std::strerror(errno) : png.message;
    std::error_code kept;  // removes an incomplete picture
    if (std::filesystem::is_regular_file(file, kept)) std::filesystem::remove(file, kept);
    fail(file, reason);
}

types::Image readPng(const std::filesystem::path& file) {
    png_image png{};
    png.version = PNG_IMAGE_VERSION;
    if (!png_image_begin_read_from_file(&png, file.c_str())) throw std::runtime_error(png.message);
    constexpr png_uint_32 largest = 16384;  // [px]
    if (png.width > largest || png.height > largest) {
        png_image_free(&png);
        throw std::runtime_error("is a picture of more than 16384 pixels on a side");
    }
    png.format = PNG_FORMAT_GRAY;
    types::Image picture;
    picture.size = {static_cast<uint16_t>(png.width), static_cast<uint16_t>(png.height)};
    picture.row_size = png.width;
    picture.image.resize(size_t{png.width} * png.height);
    if (!png_image_finish_read(&png, nullptr, picture.image.data(), 0, nullptr)) throw std::runtime_error(png.message);
    return picture;
}

PictureFiles::PictureFiles(const RecordingConfig& config, const std::filesystem::path& folder) : folder_(folder) {
    if (config.file) {
        pattern_ = FilePattern::parse(*config.file);
        std::filesystem::create_directories((folder / *config.file).parent_path());
    }
    if (config.video) {
        video_.emplace(folder / *config.video, config.video_rate);
        std::filesystem::create_directories((folder / *config.video).parent_path());
    }
}

void PictureFiles::write(const types::Image& picture) {
    if (pattern_) pattern_->format().write(folder_ / pattern_->name(number_++), picture);
    if (video_) video_->write(picture);
}

void PictureFiles::close() {
    if (video_) video_->close();
}

}  // namespace insonify::output
