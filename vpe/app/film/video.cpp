#include "vpe/app/film/video.h"

#include <cmath>
#include <cstdio>
#include <stdexcept>

#include "vpe/app/film/planar_420.h"

namespace vpe::app {

namespace fs = std::filesystem;

namespace {

using Words = std::vector<std::string>;

Words& append(Words& words, const Words& more) {
  words.insert(words.end(), more.begin(), more.end());
  return words;
}

// ffmpeg takes a leading '-' for an option and a ':' for a protocol.
std::string file_word(const fs::path& path) { return "file:" + path.string(); }

// Ticks of the film's clock: a whole number per frame, and more than 10 000 per second, as ffmpeg's muxer
// requires.
struct Clock {
  std::int64_t ticks_per_s;
  std::int64_t ticks_per_frame;
};
Clock clock_of(const scripts::FrameRate& rate) {
  Clock clock{rate.numerator, rate.denominator};
  while (clock.ticks_per_s <= 10'000) clock = {2 * clock.ticks_per_s, 2 * clock.ticks_per_frame};
  return clock;
}

Words timescale(const VideoFormat& format) {
  return {"-video_track_timescale", std::to_string(clock_of(format.rate).ticks_per_s)};
}

Words input_words(const VideoFormat& format) {
  return {"-f",         "rawvideo",
          "-pix_fmt",   "yuv420p",
          "-s",         std::to_string(format.width) + "x" + std::to_string(format.height),
          "-framerate", scripts::to_text(format.rate)};
}

// The file says what to_planar_420() has made: players take untagged HD for that, whatever matrix made it.
Words encoder_words(const VideoFormat& format) {
  Words words{"-colorspace", "bt709", "-color_primaries", "bt709", "-color_trc", "bt709", "-color_range", "tv"};
  // As like the frames as veryfast in 0.6 of its time; files are a seventh larger (docs/measurements/films.md).
  append(words, {"-c:v", "libx264", "-preset", "superfast", "-crf", "18", "-threads", "4", "-x264-params",
                 "open-gop=0:mbtree=1:rc-lookahead=10"});
  return append(words, timescale(format));
}

Words ffmpeg() { return {"ffmpeg", "-y", "-nostdin", "-loglevel", "error"}; }

Words segment_words(const VideoFormat& format, const fs::path& to) {
  Words words = ffmpeg();
  append(words, input_words(format));
  append(words, {"-i", "-"});
  append(words, encoder_words(format));
  return append(words, {"-f", "mp4", file_word(to)});
}

Subprocess start_ffmpeg(const Words& words, const fs::path& film, const fs::path& folder = {}) try {
  return Subprocess(words, folder);
} catch (const std::runtime_error& e) {
  throw std::runtime_error(film.string() + ": " + e.what() +
                           "; install ffmpeg, or give a folder to get PNG frames");
}

std::string microseconds(double us) {
  char text[48];
  std::snprintf(text, sizeof text, "%.6f", us * 1e-6);
  return text;
}

// Returns the input of ffmpeg's concat demuxer. The start of each segment is rounded to its microseconds, so
// that rounding errors do not add up.
std::string join_list(std::span<const VideoSegment> segments, const scripts::FrameRate& rate) {
  std::string text = "ffconcat version 1.0\n";
  double begin_us = 0;
  std::int64_t frames = 0;
  for (const VideoSegment& s : segments) {
    frames += s.frames;
    const double end_us = std::round(1e6 * scripts::frame_time(rate, frames));
    text.append("file ")
        .append(s.name)
        .append("\nduration ")
        .append(microseconds(end_us - begin_us))
        .append("\n");
    begin_us = end_us;
  }
  return text;
}

// Returns the bitstream filter that makes time stamps exact: the concat demuxer's are within a microsecond.
std::string exact_times(const scripts::FrameRate& rate) {
  const std::string tick = std::to_string(clock_of(rate).ticks_per_frame);
  return "setts=dts=STARTDTS+N*" + tick + ":pts=round(PTS/" + tick + ")*" + tick + ":duration=" + tick;
}

std::string with_message(const std::string& what, const std::string& words) {
  return words.empty() ? what : what + ": ffmpeg reports: " + words;
}

}  // namespace

void check_video_format(const fs::path& film, const VideoFormat& format) {
  if (format.width % 2 == 0 && format.height % 2 == 0) return;
  throw std::runtime_error(film.string() + ": a video needs an even width and height, not " +
                           std::to_string(format.width) + "x" + std::to_string(format.height));
}

std::string encoder_settings(const VideoFormat& format) {
  std::string text;
  for (const Words& words : {input_words(format), encoder_words(format)}) {
    for (const std::string& word : words) text += word + " ";
  }
  return text;
}

std::string encoder_version(const fs::path& film) {
  Subprocess child = start_ffmpeg({"ffmpeg", "-version"}, film);
  if (!child.finish()) {
    throw std::runtime_error(with_message(film.string() + ": ffmpeg does not run", child.stderr_text()) +
                             "; repair it, or give a folder to get PNG frames");
  }
  const std::string text = child.output();
  return text.substr(0, text.find('\n'));
}

VideoWriter::VideoWriter(const fs::path& path, const VideoFormat& format)
    : file_(path), ffmpeg_(start_ffmpeg(segment_words(format, file_.temporary()), path)) {}

VideoWriter::~VideoWriter() { static_cast<void>(ffmpeg_.finish()); }

void VideoWriter::fail(const std::string& what) {
  static_cast<void>(ffmpeg_.finish());
  throw std::runtime_error(with_message(file_.path().string() + ": " + what, ffmpeg_.stderr_text()));
}

void VideoWriter::add(const core::Frame& frame) {
  to_planar_420(frame.colour, frame.width, frame.height, planes_);
  if (!ffmpeg_.write(planes_)) fail("cannot write the video");
}

void VideoWriter::close() {
  if (!ffmpeg_.finish()) fail("ffmpeg failed");
  file_.commit();
}

void join_video(const fs::path& folder, std::span<const VideoSegment> segments, const VideoFormat& format,
                const fs::path& film) {
  base::OutputFile list(folder / "join.txt");  // never committed
  const std::string text = join_list(segments, format.rate);
  list.write({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
  list.flush();
  base::OutputFile joined(film);
  Words words = ffmpeg();
  // The demuxer takes the list's name for a URL: a folder with '#' or '?' in its name would be cut there. So
  // ffmpeg runs in the folder, and sees no other name than those that vpe makes.
  const std::string list_name = list.temporary().filename().string();
  append(words, {"-f", "concat", "-safe", "0", "-i", file_word(list_name), "-c", "copy"});
  append(words, {"-bsf:v", exact_times(format.rate)});
  append(words, timescale(format));
  if (!format.comment.empty()) append(words, {"-metadata", "comment=" + format.comment});
  append(words, {"-movflags", "+faststart", "-f", "mp4", file_word(fs::absolute(joined.temporary()))});
  Subprocess child = start_ffmpeg(words, film, folder);
  if (!child.finish()) {
    throw std::runtime_error(
        with_message(film.string() + ": cannot join the video", child.stderr_text()) +
        "; check the free space there; its segments are kept, and the same command joins them");
  }
  joined.commit();
}

}  // namespace vpe::app
