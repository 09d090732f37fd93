// SPDX-License-Identifier: MIT
#include "source/script/script_text.hpp"

#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <utility>

#include "mc/base.hpp"
#include "source/script/script.hpp"

// A stream is read as its bytes come: never more is waited for than the line that is asked for.

namespace mc::source {

namespace {

/// Finds where the first JSON value of a text ends, by its brackets alone.
class ValueEnd {
 public:
  /// Whether the value ends within `more`, which follows what was seen before.
  bool passes(std::string_view more) {
    for (const char c : more) {
      if (in_string_) {
        if (escaped_) {
          escaped_ = false;
        } else if (c == '\\') {
          escaped_ = true;
        } else if (c == '"') {
          in_string_ = false;
        }
      } else if (c == '"') {
        in_string_ = seen_ = true;
      } else if (c == '{' || c == '[') {
        ++depth_;
        seen_ = true;
      } else if (c == '}' || c == ']') {
        --depth_;
      } else if (c != ' ' && c != '\t' && c != '\r' && c != '\n') {
        seen_ = true;
      }
    }
    return seen_ && !in_string_ && depth_ <= 0;
  }

 private:
  bool in_string_ = false, escaped_ = false, seen_ = false;
  std::int64_t depth_ = 0;
};

std::string_view without_return(std::string_view line) {
  if (line.ends_with('\r')) line.remove_suffix(1);
  return line;
}

class MemoryText final : public ScriptText {
 public:
  explicit MemoryText(std::string_view text) : text_(text) {}

  TextPiece head() override {
    ValueEnd end;
    while (at_ < text_.size()) {
      if (end.passes(take().text)) break;
    }
    head_end_ = at_;
    head_lines_ = line_;
    return {text_.substr(0, at_), 1};
  }
  std::optional<TextPiece> line() override {
    if (at_ >= text_.size()) return std::nullopt;
    return take();
  }
  std::string_view whole() override { return text_; }
  void rewind() override {
    at_ = head_end_;
    line_ = head_lines_;
  }
  [[nodiscard]] bool is_stream() const override { return false; }

 private:
  TextPiece take() {
    const std::size_t end = text_.find('\n', at_);
    const bool ended = end != std::string_view::npos;
    const TextPiece piece{without_return(text_.substr(at_, ended ? end - at_ : end)), line_++,
                          ended};
    at_ = ended ? end + 1 : text_.size();
    return piece;
  }

  std::string_view text_;
  std::size_t at_ = 0, line_ = 1;
  std::size_t head_end_ = 0, head_lines_ = 1;
};

class StreamText final : public ScriptText {
 public:
  StreamText(int descriptor, std::string place)
      : descriptor_(descriptor), place_(std::move(place)) {}

  TextPiece head() override {
    ValueEnd end;
    while (const auto next = line()) {
      const bool is_whole = end.passes(next->text);
      head_.append(next->text).append(next->is_complete ? "\n" : "");
      check_size(head_.size());
      if (is_whole) break;
    }
    return {head_, 1};
  }
  std::optional<TextPiece> line() override {
    pending_.erase(0, taken_);
    taken_ = 0;
    std::size_t looked_at = 0;
    for (;;) {
      const std::size_t end = pending_.find('\n', looked_at);
      if (end != std::string::npos) {
        taken_ = end + 1;
        return TextPiece{without_return(std::string_view(pending_).substr(0, end)), line_++};
      }
      looked_at = pending_.size();
      check_size(looked_at);
      if (!fill()) break;
    }
    taken_ = pending_.size();
    if (pending_.empty()) return std::nullopt;
    return TextPiece{without_return(pending_), line_++, false};
  }
  /// A document is waited for whole.
  std::string_view whole() override {
    while (const auto next = line()) {
      head_.append(next->text).append(next->is_complete ? "\n" : "");
      check_size(head_.size());
    }
    return head_;
  }
  void rewind() override {}
  [[nodiscard]] bool is_stream() const override { return true; }

 private:
  bool fill() {
    std::array<char, 65536> bytes;
    ssize_t n = -1;
    do {
      n = ::read(descriptor_, bytes.data(), bytes.size());
    } while (n < 0 && errno == EINTR);
    if (n < 0) {
      throw Error(ErrorKind::input, place_, std::string("cannot read: ") + std::strerror(errno));
    }
    pending_.append(bytes.data(), static_cast<std::size_t>(n));
    return n > 0;
  }
  void check_size(std::size_t n_bytes) const {
    if (n_bytes > Script::kMostLineBytes) {
      throw Error(ErrorKind::limit, place_ + ":" + std::to_string(line_),
                  "a record is longer than " + std::to_string(Script::kMostLineBytes) + " bytes",
                  "part it into several");
    }
  }

  int descriptor_;
  std::string place_;
  std::string head_, pending_;
  std::size_t taken_ = 0;  // bytes of `pending_` that were handed out
  std::size_t line_ = 1;
};

}  // namespace

std::unique_ptr<ScriptText> text_in_memory(std::string_view text) {
  return std::make_unique<MemoryText>(text);
}

std::unique_ptr<ScriptText> text_of_stream(int descriptor, std::string place) {
  return std::make_unique<StreamText>(descriptor, std::move(place));
}

}  // namespace mc::source
