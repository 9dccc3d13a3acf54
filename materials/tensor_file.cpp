// SPDX-License-Identifier: Apache-2.0
#include "materials/tensor_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cstring>
#include <limits>
#include <optional>
#include <type_traits>
#include <utility>

#include "core/base/error.h"
#include "core/base/file.h"
#include "materials/foreign_bsdf.h"

namespace spectrace {

static_assert(std::endian::native == std::endian::little,
              "tensor files are little endian, read without swaps");

namespace {

constexpr std::string_view kMagic{"tensor_file\0", 12};  // the terminating zero belongs to it
constexpr std::uint8_t kMajorVersion = 1, kMinorVersion = 0;
constexpr std::size_t kAlignment = 8;       // of field data: what the database's own files keep
constexpr std::uint32_t kMaxFields = 4096;  // real files: 13; keeps the search for duplicates short
constexpr std::size_t kShownName = 40;      // of a damaged name: enough to find it
constexpr int kMaxDimensions = 32;          // numpy's limit; keeps messages to a line
constexpr std::size_t kHeadSize = kMagic.size() + 2 + sizeof(std::uint32_t);

/// For messages: control and non-ASCII bytes as \xNN, so that a hostile name cannot break the line.
std::string printable(std::string_view text) {
  std::string out;
  for (const unsigned char c : text) {
    if (c >= 0x20 && c < 0x7f && c != '"' && c != '\\') {
      out += static_cast<char>(c);
    } else {
      out += fmt::format("\\x{:02x}", c);
    }
  }
  return out;
}

bool is_plain_name(std::string_view name) {
  return !name.empty() && std::all_of(name.begin(), name.end(), [](char c) { return c > 0x20 && c < 0x7f; });
}

std::string at_byte(std::uint64_t offset, std::string_view field = {}) {
  return field.empty() ? fmt::format("byte {}", offset) : fmt::format("byte {}: field \"{}\"", offset, field);
}

/// nullopt where the product does not fit.
std::optional<std::uint64_t> product(std::span<const std::uint64_t> shape) {
  if (std::find(shape.begin(), shape.end(), 0) != shape.end()) return 0;
  std::uint64_t n = 1;
  for (const std::uint64_t extent : shape) {
    if (n > std::numeric_limits<std::uint64_t>::max() / extent) return std::nullopt;
    n *= extent;
  }
  return n;
}

[[noreturn]] void refuse_magic(std::span<const std::byte> bytes, const std::string& file_name) {
  std::string problem = R"(expected a tensor file of the EPFL material database ("tensor_file"), found )";
  const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  if (const auto foreign = foreign_bsdf(text); !foreign.empty()) {
    problem += foreign;
  } else if (bytes.empty()) {
    problem += "an empty file";
  } else if (kMagic.starts_with(text)) {
    problem += fmt::format("its first {} bytes only: truncated", bytes.size());
  } else {
    problem += fmt::format("\"{}\"", printable(text.substr(0, kMagic.size())));
  }
  throw InputError(file_name, at_byte(0), problem);
}

/// Reads the header front to back; every read is checked against the end of the file.
class HeaderCursor {
 public:
  HeaderCursor(std::span<const std::byte> bytes, const std::string& file_name)
      : bytes_(bytes), file_name_(file_name) {}

  template <typename T>
  T number(std::string_view what) {
    T value;
    std::memcpy(&value, take(sizeof(T), what).data(), sizeof(T));
    return value;
  }
  std::string_view text(std::size_t size, std::string_view what) {
    const auto raw = take(size, what);
    return {reinterpret_cast<const char*>(raw.data()), raw.size()};
  }
  [[nodiscard]] std::size_t position() const { return position_; }
  [[nodiscard]] std::size_t remaining() const { return bytes_.size() - position_; }
  [[noreturn]] void fail(std::size_t position, std::string problem) const {
    throw InputError(file_name_, at_byte(position, field_), std::move(problem));
  }
  void enter_field(std::string name) { field_ = std::move(name); }

 private:
  std::span<const std::byte> take(std::size_t size, std::string_view what) {
    if (size > remaining()) {
      fail(position_,
           fmt::format("truncated: {} needs {} bytes, the file ends after {}", what, size, remaining()));
    }
    position_ += size;
    return bytes_.subspan(position_ - size, size);
  }

  std::span<const std::byte> bytes_;
  const std::string& file_name_;
  std::size_t position_ = 0;
  std::string field_;
};

/// One field's entry of the header; its bytes are not copied yet.
Tensor read_entry(HeaderCursor& in, std::span<const std::byte> bytes) {
  in.enter_field("");
  const std::size_t begin = in.position();
  const auto name_size = in.number<std::uint16_t>("a field's name length");
  const std::string_view name = in.text(name_size, "a field's name");
  if (!is_plain_name(name)) {
    in.fail(begin, fmt::format("field name \"{}\"{}: expected printable ASCII without spaces",
                               printable(name.substr(0, kShownName)),
                               name.size() > kShownName ? fmt::format("... of {} bytes", name.size())
                                                        : std::string()));
  }
  in.enter_field(std::string(name));

  Tensor tensor;
  tensor.name = name;
  const auto dimensions = in.number<std::uint16_t>("the number of dimensions");
  const std::size_t type_at = in.position();
  const auto type = in.number<std::uint8_t>("the element type");
  if (type < static_cast<std::uint8_t>(TensorType::kU8) ||
      type > static_cast<std::uint8_t>(TensorType::kF64)) {
    in.fail(type_at, fmt::format("element type {}, expected 1 (u8) to 11 (f64)", type));
  }
  tensor.type = static_cast<TensorType>(type);
  const std::size_t offset_at = in.position();
  tensor.offset = in.number<std::uint64_t>("the data offset");
  const std::size_t shape_at = in.position();
  if (dimensions > kMaxDimensions) {
    in.fail(shape_at, fmt::format("{} dimensions, expected at most {}", dimensions, kMaxDimensions));
  }
  if (dimensions * sizeof(std::uint64_t) > in.remaining()) {
    in.fail(shape_at,
            fmt::format("truncated: a shape of {} dimensions does not fit in the file", dimensions));
  }
  for (int d = 0; d < dimensions; ++d) tensor.shape.push_back(in.number<std::uint64_t>("the shape"));

  const auto count = product(tensor.shape);
  if (!count || *count > bytes.size() / size_of(tensor.type)) {
    in.fail(shape_at, fmt::format("shape {} of {} is larger than the file ({} bytes)", tensor.shape_text(),
                                  name_of(tensor.type), bytes.size()));
  }
  const std::size_t size = *count * size_of(tensor.type);
  if (tensor.offset > bytes.size() || size > bytes.size() - tensor.offset) {
    in.fail(offset_at,
            fmt::format("data at byte {} with {} bytes reach beyond the end of the file ({} bytes)",
                        tensor.offset, size, bytes.size()));
  }
  return tensor;
}

/// From a damaged offset, shape or number of fields follows that some field's data belong to none: padding
/// is 0, as in the database's own files.
void refuse_stray_bytes(std::span<const std::byte> bytes, std::uint64_t first, std::uint64_t end,
                        const std::string& file_name) {
  const auto gap = bytes.subspan(first, end - first);
  const auto stray = std::find_if(gap.begin(), gap.end(), [](std::byte b) { return b != std::byte(0); });
  if (stray == gap.end()) return;
  throw InputError(file_name, at_byte(first + std::uint64_t(stray - gap.begin())),
                   "belongs to no field, and is no padding (0)");
}

/// `alignment` is a power of two.
constexpr std::uint64_t aligned(std::uint64_t position, std::uint64_t alignment) {
  return (position + alignment - 1) / alignment * alignment;
}

/// Tensors that hold anything, in the order of their data.
std::vector<const Tensor*> by_offset(const std::vector<Tensor>& tensors) {
  std::vector<const Tensor*> sorted;
  for (const Tensor& tensor : tensors) {
    if (tensor.count() > 0) sorted.push_back(&tensor);
  }
  std::sort(sorted.begin(), sorted.end(),
            [](const Tensor* a, const Tensor* b) { return a->offset < b->offset; });
  return sorted;
}

std::uint64_t end_of(const Tensor& tensor) { return tensor.offset + tensor.count() * size_of(tensor.type); }

/// Writers put one field behind another, each at the next multiple of some power of two: which one is theirs
/// to choose, but a field that lies elsewhere than its neighbours say has a damaged offset, even where only
/// zeros moved.
void refuse_shifted(const std::vector<Tensor>& tensors, const std::string& file_name) {
  constexpr std::uint64_t kMostAligned = 4096;  // a page
  const std::vector<const Tensor*> sorted = by_offset(tensors);
  const Tensor* shifted = nullptr;
  std::size_t fewest = sorted.size();
  for (std::uint64_t alignment = kMostAligned; alignment >= 1 && fewest > 0; alignment /= 2) {
    std::size_t count = 0;
    const Tensor* first = nullptr;
    for (std::size_t i = 1; i < sorted.size(); ++i) {
      if (sorted[i]->offset == aligned(end_of(*sorted[i - 1]), alignment)) continue;
      if (count++ == 0) first = sorted[i];
    }
    if (count < fewest) fewest = count, shifted = first;
  }
  if (shifted == nullptr) return;
  throw InputError(file_name, at_byte(shifted->offset, shifted->name),
                   "its data do not lie where those of the other fields end");
}

/// Without this a small file could ask for its bytes many times over, and damage to the header would read the
/// bytes of one field as another's.
void refuse_overlaps_and_strays(const std::vector<Tensor>& tensors, std::span<const std::byte> bytes,
                                std::size_t header_size, const std::string& file_name) {
  std::uint64_t end = header_size;
  std::string previous = "header";
  for (const Tensor* tensor : by_offset(tensors)) {
    if (tensor->offset < end) {
      throw InputError(file_name, at_byte(tensor->offset, tensor->name),
                       fmt::format("its data overlap the {}, which ends at byte {}", previous, end));
    }
    refuse_stray_bytes(bytes, end, tensor->offset, file_name);
    end = end_of(*tensor);
    previous = fmt::format("field \"{}\"", tensor->name);
  }
  refuse_stray_bytes(bytes, end, bytes.size(), file_name);
}

void append(std::vector<std::byte>& out, std::span<const std::byte> raw) {
  // Not insert(): inlined into an empty vector, GCC 12 takes it for an overflow.
  const std::size_t at = out.size();
  out.resize(at + raw.size());
  std::memcpy(out.data() + at, raw.data(), raw.size());
}
template <typename T>
requires std::is_arithmetic_v<T>
void append(std::vector<std::byte>& out, T value) { append(out, std::as_bytes(std::span(&value, 1))); }
void append(std::vector<std::byte>& out, std::string_view text) {
  append(out, std::as_bytes(std::span(text)));
}

}  // namespace

bool TensorFile::has_magic(std::span<const std::byte> bytes) {
  return bytes.size() >= kMagic.size() && std::memcmp(bytes.data(), kMagic.data(), kMagic.size()) == 0;
}

TensorFile TensorFile::read(const std::filesystem::path& file) {
  return parse(read_file(file), file.string());
}

TensorFile TensorFile::parse(std::span<const std::byte> bytes, std::string file_name) {
  if (!has_magic(bytes)) refuse_magic(bytes, file_name);
  TensorFile out;
  out.file_name_ = std::move(file_name);
  HeaderCursor in(bytes, out.file_name_);
  (void)in.text(kMagic.size(), "the magic");
  const auto major = in.number<std::uint8_t>("the version");
  const auto minor = in.number<std::uint8_t>("the version");
  if (major != kMajorVersion || minor != kMinorVersion) {
    in.fail(kMagic.size(), fmt::format("tensor file version {}.{}, expected {}.{}", major, minor,
                                       kMajorVersion, kMinorVersion));
  }
  const auto fields = in.number<std::uint32_t>("the number of fields");
  if (fields > kMaxFields) {
    in.fail(kMagic.size() + 2, fmt::format("{} fields, expected at most {}", fields, kMaxFields));
  }
  for (std::uint32_t i = 0; i < fields; ++i) {
    const std::size_t begin = in.position();
    Tensor tensor = read_entry(in, bytes);
    if (out.find(tensor.name) != nullptr) in.fail(begin, "a second field of this name");
    out.tensors_.push_back(std::move(tensor));
  }
  refuse_overlaps_and_strays(out.tensors_, bytes, in.position(), out.file_name_);
  refuse_shifted(out.tensors_, out.file_name_);
  for (Tensor& tensor : out.tensors_) {
    const auto raw = bytes.subspan(tensor.offset, tensor.count() * size_of(tensor.type));
    tensor.bytes.assign(raw.begin(), raw.end());
  }
  return out;
}

const Tensor* TensorFile::find(std::string_view name) const {
  const auto it =
      std::find_if(tensors_.begin(), tensors_.end(), [&](const Tensor& t) { return t.name == name; });
  return it == tensors_.end() ? nullptr : &*it;
}

const Tensor& TensorFile::require(std::string_view name, std::span<const TensorType> types,
                                  std::span<const std::size_t> shape) const {
  const Tensor* tensor = find(name);
  if (tensor == nullptr) {
    std::vector<std::string_view> present;
    for (const Tensor& t : tensors_) present.push_back(t.name);
    throw InputError(file_name_, fmt::format("field \"{}\"", name),
                     fmt::format("missing; the file holds {}",
                                 present.empty() ? "no field" : fmt::format("{}", fmt::join(present, ", "))));
  }
  if (std::find(types.begin(), types.end(), tensor->type) == types.end()) {
    std::vector<std::string_view> names;
    for (const TensorType type : types) names.push_back(name_of(type));
    throw InputError(
        file_name_, at_byte(tensor->offset, name),
        fmt::format("element type {}, expected {}", name_of(tensor->type), fmt::join(names, " or ")));
  }
  const bool fits =
      std::equal(shape.begin(), shape.end(), tensor->shape.begin(), tensor->shape.end(),
                 [](std::size_t wanted, std::size_t found) { return wanted == 0 || wanted == found; });
  if (!fits) {
    std::vector<std::string> wanted;
    for (const std::size_t extent : shape) wanted.push_back(extent == 0 ? "any" : fmt::format("{}", extent));
    throw InputError(file_name_, at_byte(tensor->offset, name),
                     fmt::format("shape {}, expected [{}]", tensor->shape_text(), fmt::join(wanted, ",")));
  }
  return *tensor;
}

void TensorFile::add(Tensor tensor) {
  SPECTRACE_CHECK(is_plain_name(tensor.name) && find(tensor.name) == nullptr);
  SPECTRACE_CHECK(tensor.bytes.size() == tensor.count() * size_of(tensor.type));
  tensors_.push_back(std::move(tensor));
}

std::vector<std::byte> TensorFile::serialize() const {
  std::size_t header_size = kHeadSize;
  for (const Tensor& t : tensors_) {
    header_size +=
        sizeof(std::uint16_t) * 2 + 1 + sizeof(std::uint64_t) * (1 + t.shape.size()) + t.name.size();
  }
  std::vector<std::byte> out;
  append(out, kMagic);
  append(out, kMajorVersion);
  append(out, kMinorVersion);
  append(out, static_cast<std::uint32_t>(tensors_.size()));
  std::size_t offset = aligned(header_size, kAlignment);
  for (const Tensor& t : tensors_) {
    append(out, static_cast<std::uint16_t>(t.name.size()));
    append(out, t.name);
    append(out, static_cast<std::uint16_t>(t.shape.size()));
    append(out, static_cast<std::uint8_t>(t.type));
    append(out, static_cast<std::uint64_t>(offset));
    for (const std::size_t extent : t.shape) append(out, static_cast<std::uint64_t>(extent));
    offset = aligned(offset + t.bytes.size(), kAlignment);
  }
  for (const Tensor& t : tensors_) {
    out.resize(aligned(out.size(), kAlignment));
    out.insert(out.end(), t.bytes.begin(), t.bytes.end());
  }
  return out;
}

void TensorFile::write(const std::filesystem::path& file) const { write_file_atomically(file, serialize()); }

}  // namespace spectrace
