// SPDX-License-Identifier: MIT
#include "source/script/script.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cassert>
#include <filesystem>
#include <utility>

#include "source/json/write_json.hpp"
#include "source/mapped_file.hpp"
#include "source/script/header.hpp"
#include "source/script/record_reader.hpp"
#include "source/script/script_text.hpp"
#include "source/stream/byte_stream.hpp"

// A document is one tree, whose "edits" are read one after the other; of JSON Lines each line is a
// tree of its own.

namespace mc::source {

namespace {

// Groups nest, and nodes nest in them; a path may have a million points.
constexpr JsonLimits kLimits{.depth = 256, .n_values = 5'000'000};

bool is_blank(std::string_view text) {
  return text.find_first_not_of(" \t\r\n") == std::string_view::npos;
}

bool is_stream(const std::string& path) {
  struct stat status {};
  if (path == "-") return true;
  return ::stat(path.c_str(), &status) == 0 && !S_ISREG(status.st_mode) && !S_ISDIR(status.st_mode);
}

/// The faults of several texts of one file.
class FaultLines {
 public:
  void add(const Error& error) {
    lines_.insert(lines_.end(), error.lines().begin(), error.lines().end());
  }
  [[nodiscard]] bool full() const { return lines_.size() > Faults::kMost; }
  void throw_if_any(const std::string& place) {
    if (lines_.empty()) return;
    if (full()) {
      lines_.resize(Faults::kMost - 1);
      lines_.push_back(place + ": more faults; correct those above first");
    }
    throw Error(ErrorKind::usage, std::move(lines_));
  }

 private:
  std::vector<std::string> lines_;
};

}  // namespace

struct Script::State {
  std::string place;
  SpecNesting within;
  std::unique_ptr<Descriptor> descriptor;
  std::unique_ptr<MappedFile> file;
  std::string own_text;  ///< of a script in memory
  std::unique_ptr<ScriptText> text;
  std::string head_text;  // what `root` was parsed from
  std::unique_ptr<JsonValue> root;
  const JsonValue* edits = nullptr;  // of a document
  std::unique_ptr<ScriptContext> context;
  std::uint64_t n_read = 0;  // records
  std::string torn;

  void open();
  void open_header(Faults& faults);
  std::optional<ScriptRecord> next();
  std::optional<ScriptRecord> next_edit();
  std::optional<ScriptRecord> next_line();
  ScriptRecord read_line(const TextPiece& piece);
  void gather(FaultLines& faults, const std::function<void(const ScriptRecord&)>& look);
  void rewind();
};

void Script::State::open() {
  head_text = text->head().text;
  auto faults = std::make_unique<Faults>(place, head_text);
  std::optional<JsonValue> parsed = parse_json(*faults, kLimits);
  if (parsed && parsed->find("edits") != nullptr) {
    // A document: what follows it on other lines is its own fault.
    if (const std::string_view all = text->whole(); !is_blank(all.substr(head_text.size()))) {
      head_text = all;
      faults = std::make_unique<Faults>(place, head_text);
      parsed = parse_json(*faults, kLimits);
    }
  }
  if (!parsed) {
    faults->throw_if_any();
    throw Error(ErrorKind::internal, place, "was not parsed, and nothing says why");
  }
  root = std::make_unique<JsonValue>(std::move(*parsed));
  open_header(*faults);
}

void Script::State::open_header(Faults& faults) {
  const JsonDocument document{*root, faults};
  context = std::make_unique<ScriptContext>(base_of(*root, place), within);
  ObjectReader keys(document, *root, "an mc-edits script");
  read_header(document, keys, *context);
  edits = keys.optional("edits");
  if (edits != nullptr && edits->kind != JsonKind::array) {
    document.fault(*edits, as_found(*edits) + ": expected an array of records");
    edits = nullptr;
  }
  keys.finish();
  if (faults.empty()) return;
  FaultLines lines;
  if (edits != nullptr) {
    RecordReader reader(document, *context);
    for (const JsonValue& item : edits->items) reader.read(item);
  }
  try {
    faults.throw_if_any();
  } catch (const Error& error) {
    lines.add(error);
  }
  if (edits == nullptr && !text->is_stream()) gather(lines, [](const ScriptRecord&) {});
  lines.throw_if_any(place);
}

std::optional<ScriptRecord> Script::State::next() {
  return edits != nullptr ? next_edit() : next_line();
}

std::optional<ScriptRecord> Script::State::next_edit() {
  if (n_read >= edits->items.size()) return std::nullopt;
  Faults faults(place, head_text);
  const JsonDocument document{*root, faults};
  ScriptRecord record = RecordReader(document, *context).read(edits->items[n_read++]);
  faults.throw_if_any();
  record.number = n_read;
  return record;
}

std::optional<ScriptRecord> Script::State::next_line() {
  while (const std::optional<TextPiece> piece = text->line()) {
    if (is_blank(piece->text)) continue;
    ++n_read;
    Faults faults(place, piece->text, piece->line, "record " + std::to_string(n_read));
    const std::optional<JsonValue> parsed = parse_json(faults, kLimits);
    if (!parsed && !piece->is_complete && context->header.journal) {
      torn = place + ":" + std::to_string(piece->line);
      return std::nullopt;
    }
    if (!parsed) faults.throw_if_any();
    const JsonDocument document{*parsed, faults};
    ScriptRecord record = RecordReader(document, *context).read(*parsed);
    faults.throw_if_any();
    record.number = n_read;
    return record;
  }
  return std::nullopt;
}

void Script::State::rewind() {
  text->rewind();
  n_read = 0;
}

void Script::State::gather(FaultLines& faults,
                           const std::function<void(const ScriptRecord&)>& look) {
  while (!faults.full()) {
    try {
      const std::optional<ScriptRecord> record = next();
      if (!record) break;
      look(*record);
    } catch (const Error& error) {
      if (error.kind() != ErrorKind::usage) throw;
      faults.add(error);
    }
  }
  rewind();
}

Script::Script(const std::string& path, const SpecNesting& within)
    : state_(std::make_unique<State>()) {
  State& s = *state_;
  s.within = within;
  if (is_stream(path)) {
    s.place = path == "-" ? "<stdin>" : path;
    s.descriptor = std::make_unique<Descriptor>(
        path == "-" ? STDIN_FILENO : ::open(path.c_str(), O_RDONLY | O_CLOEXEC));
    s.text = text_of_stream(s.descriptor->get(), s.place);
  } else {
    s.file = std::make_unique<MappedFile>(path);
    s.place = s.file->place();
    s.text = text_in_memory(s.file->text());
  }
  s.open();
}

Script::Script(std::string place, std::string text) : state_(std::make_unique<State>()) {
  state_->place = std::move(place);
  state_->own_text = std::move(text);
  state_->text = text_in_memory(state_->own_text);
  state_->open();
}

Script::~Script() = default;
Script::Script(Script&& other) noexcept = default;
Script& Script::operator=(Script&& other) noexcept = default;

const std::string& Script::place() const { return state_->place; }
const ScriptHeader& Script::header() const { return state_->context->header; }
bool Script::is_live() const { return state_->edits == nullptr && state_->text->is_stream(); }
const std::string& Script::torn() const { return state_->torn; }

std::string Script::journal_header() const {
  std::string out = R"({"format":"mc-edits","version":1,"journal":true,"folder":)";
  std::error_code ignored;
  const auto base = std::filesystem::path(base_of(*state_->root, state_->place)).parent_path();
  write_json_text(std::filesystem::weakly_canonical(base.empty() ? "." : base, ignored).string(),
                  out);
  for (const JsonMember& member : state_->root->members) {
    const auto is = [&](std::string_view key) { return member.key == key; };
    if (is("format") || is("version") || is("journal") || is("folder") || is("edits") ||
        is("defaults") || is_ignored_key(member.key)) {
      continue;
    }
    out += ',';
    write_json_text(member.key, out);
    out += ':';
    write_json(member.value, out);
  }
  return out += '}';
}

std::optional<ScriptRecord> Script::next() { return state_->next(); }

void Script::check(const std::function<void(const ScriptRecord&)>& look) {
  assert(!is_live());
  FaultLines faults;
  state_->gather(faults, look);
  faults.throw_if_any(state_->place);
}

std::string path_of_write(std::string_view pattern, std::uint64_t n) {
  std::string path;
  while (!pattern.empty()) {
    const std::size_t end = pattern.starts_with("{n") ? pattern.find('}') : std::string_view::npos;
    const std::string_view inner =
        end == std::string_view::npos ? std::string_view() : pattern.substr(1, end - 1);
    const bool padded =
        inner.size() == 4 && inner.starts_with("n:0") && inner[3] >= '1' && inner[3] <= '9';
    if (inner != "n" && !padded) {
      path += pattern.front();
      pattern.remove_prefix(1);
      continue;
    }
    const std::string digits = std::to_string(n);
    const std::size_t width = padded ? static_cast<std::size_t>(inner[3] - '0') : 0;
    path += std::string(width > digits.size() ? width - digits.size() : 0, '0') + digits;
    pattern.remove_prefix(end + 1);
  }
  return path;
}

}  // namespace mc::source
