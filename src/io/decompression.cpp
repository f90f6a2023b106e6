#include "io/decompression.h"

#include <algorithm>
#include <fstream>
#include <limits>
#include <memory>

#ifdef PCL_FLOAM_WITH_BZ2
#include <bzlib.h>
#endif
#ifdef PCL_FLOAM_WITH_LZ4
#include <lz4frame.h>
#endif
#ifdef PCL_FLOAM_WITH_ZSTD
#include <zstd.h>
#endif

namespace pcl_floam {

namespace {

/// Bytes; as BinaryFile's: nothing unpacks to more.
constexpr std::uint64_t kLargest = 1ULL << 30U;
constexpr std::size_t kFirstPiece = 1U << 16U;

/// The unpacked bytes so far, in room that grows as they come.
class Output {
public:
  Output(std::string& content, std::uint64_t most, std::size_t packed) : content_(content), most_(most)
  {
    // What was usual packing gives no second allocation; a lie about the size costs no memory.
    constexpr std::uint64_t kUsualRatio = 8;
    content_.resize(std::min(most_, std::max<std::uint64_t>(kFirstPiece, kUsualRatio * packed)));
  }

  [[nodiscard]] char* place() { return content_.data() + size_; }
  [[nodiscard]] std::size_t room() const { return content_.size() - size_; }
  [[nodiscard]] std::size_t size() const { return size_; }
  void add(std::size_t count) { size_ += count; }

  /// \return false if there is as much as there may be
  [[nodiscard]] bool grow()
  {
    if (room() == 0 && size_ < most_) {
      content_.resize(std::min<std::uint64_t>(most_, 2 * content_.size() + kFirstPiece));
    }
    return room() > 0;
  }

  void finish() { content_.resize(size_); }

private:
  std::string& content_;
  std::uint64_t most_;
  std::size_t size_ = 0;
};

enum class End : std::uint8_t { reached, packed_bytes_missing, no_room, damaged };

[[maybe_unused]] [[noreturn]] void failLeftOut(const char* library, const Origin& origin)
{
  throw FileError(origin.file, origin.part + "is compressed with " + library +
                                   ", which this build left out: install lib" + library +
                                   "-dev and configure pcl_floam again");
}

#ifdef PCL_FLOAM_WITH_LZ4
End unpackLz4(std::string_view packed, Output& output)
{
  LZ4F_dctx* raw = nullptr;
  if (LZ4F_isError(LZ4F_createDecompressionContext(&raw, LZ4F_VERSION)) != 0) {
    throw std::bad_alloc();
  }
  const std::unique_ptr<LZ4F_dctx, LZ4F_errorCode_t (*)(LZ4F_dctx*)> context(raw, LZ4F_freeDecompressionContext);
  for (std::size_t hint = 1; hint != 0;) {
    std::size_t taken = packed.size();
    (void)output.grow();
    std::size_t given = output.room();
    hint = LZ4F_decompress(context.get(), output.place(), &given, packed.data(), &taken, nullptr);
    if (LZ4F_isError(hint) != 0) {
      return End::damaged;
    }
    output.add(given);
    packed.remove_prefix(taken);
    if (hint != 0 && taken == 0 && given == 0) {
      return packed.empty() ? End::packed_bytes_missing : End::no_room;
    }
  }
  return End::reached;
}
#else
End unpackLz4(std::string_view, Output&)
{
  return End::damaged;
}
#endif

#ifdef PCL_FLOAM_WITH_ZSTD
End unpackZstd(std::string_view packed, Output& output)
{
  const std::unique_ptr<ZSTD_DStream, std::size_t (*)(ZSTD_DStream*)> stream(ZSTD_createDStream(), ZSTD_freeDStream);
  ZSTD_inBuffer in{packed.data(), packed.size(), 0};
  for (std::size_t hint = 1; hint != 0;) {
    (void)output.grow();
    ZSTD_outBuffer out{output.place(), output.room(), 0};
    const std::size_t before = in.pos;
    hint = ZSTD_decompressStream(stream.get(), &out, &in);
    if (ZSTD_isError(hint) != 0) {
      return End::damaged;
    }
    output.add(out.pos);
    if (hint != 0 && in.pos == before && out.pos == 0) {
      return in.pos == in.size ? End::packed_bytes_missing : End::no_room;
    }
  }
  return End::reached;
}
#else
End unpackZstd(std::string_view, Output&)
{
  return End::damaged;
}
#endif

#ifdef PCL_FLOAM_WITH_BZ2
End unpackBz2(std::string_view packed, Output& output)
{
  bz_stream stream{};
  if (BZ2_bzDecompressInit(&stream, 0, 0) != BZ_OK) {
    throw std::bad_alloc();
  }
  const std::unique_ptr<bz_stream, int (*)(bz_stream*)> end(&stream, BZ2_bzDecompressEnd);
  stream.next_in = const_cast<char*>(packed.data());  // the library's interface is older than const
  stream.avail_in = static_cast<unsigned>(packed.size());
  for (;;) {
    (void)output.grow();
    const auto room = static_cast<unsigned>(std::min<std::size_t>(output.room(), std::numeric_limits<unsigned>::max()));
    stream.next_out = output.place();
    stream.avail_out = room;
    const unsigned left_before = stream.avail_in;
    const int status = BZ2_bzDecompress(&stream);
    const unsigned given = room - stream.avail_out;
    output.add(given);
    if (status == BZ_STREAM_END) {
      return End::reached;
    }
    if (status != BZ_OK) {
      return End::damaged;
    }
    if (given == 0 && stream.avail_in == left_before) {
      return stream.avail_in == 0 ? End::packed_bytes_missing : End::no_room;
    }
  }
}
#else
End unpackBz2(std::string_view, Output&)
{
  return End::damaged;
}
#endif

void requireLibrary([[maybe_unused]] Compression compression, [[maybe_unused]] const Origin& origin)
{
#ifndef PCL_FLOAM_WITH_LZ4
  if (compression == Compression::lz4) {
    failLeftOut("lz4", origin);
  }
#endif
#ifndef PCL_FLOAM_WITH_ZSTD
  if (compression == Compression::zstd) {
    failLeftOut("zstd", origin);
  }
#endif
#ifndef PCL_FLOAM_WITH_BZ2
  if (compression == Compression::bz2) {
    failLeftOut("bz2", origin);
  }
#endif
}

End unpack(Compression compression, std::string_view packed, Output& output)
{
  switch (compression) {
    case Compression::lz4: return unpackLz4(packed, output);
    case Compression::zstd: return unpackZstd(packed, output);
    case Compression::bz2: return unpackBz2(packed, output);
    case Compression::none: break;
  }
  return End::damaged;
}

}  // namespace

Compression compressionOf(std::string_view name, const Origin& origin)
{
  if (name.empty() || name == "none") {
    return Compression::none;
  }
  if (name == "lz4") {
    return Compression::lz4;
  }
  if (name == "zstd") {
    return Compression::zstd;
  }
  if (name == "bz2") {
    return Compression::bz2;
  }
  origin.fail(0, "compression '" + std::string(name.substr(0, 40)) +
                     "' is not known: record again without, or with lz4, zstd or bz2");
}

void decompress(Compression compression, std::string_view packed, std::uint64_t size, bool whole, const Origin& origin,
                std::string& content)
{
  requireLibrary(compression, origin);
  if (size > kLargest) {
    origin.fail(0, "the compressed data are of " + std::to_string(size) + " bytes: the file is damaged");
  }
  Output output(content, size, packed.size());
  const End end = unpack(compression, packed, output);
  output.finish();
  if (whole && end != End::reached) {
    const char* reason = end == End::packed_bytes_missing ? "end too early"
                         : end == End::no_room            ? "are of more bytes than they should"
                                                          : "are damaged";
    origin.fail(output.size(), std::string("the compressed data ") + reason);
  }
  if (whole && output.size() != size) {
    origin.fail(output.size(), "the compressed data should be of " + std::to_string(size) + " bytes");
  }
}

bool isZstd(std::string_view bytes)
{
  return bytes.substr(0, 4) == std::string_view("\x28\xB5\x2F\xFD", 4);
}

void decompressZstd(std::string_view packed, const Origin& origin, std::string& content)
{
  requireLibrary(Compression::zstd, origin);
  Output output(content, kLargest, packed.size());
  const End end = unpackZstd(packed, output);
  output.finish();
  if (end != End::reached) {
    origin.fail(output.size(),
                end == End::packed_bytes_missing ? "the zstd frame ends too early" : "the zstd frame is damaged");
  }
}

#ifdef PCL_FLOAM_WITH_ZSTD
void decompressZstdFile(const std::filesystem::path& packed, const std::filesystem::path& unpacked)
{
  errno = 0;
  std::ifstream from(packed, std::ios::binary);
  std::ofstream to(unpacked, std::ios::binary);
  if (!from || !to) {
    throw FileError::ofSystem(from ? unpacked : packed, "cannot be opened");
  }
  const std::unique_ptr<ZSTD_DStream, std::size_t (*)(ZSTD_DStream*)> stream(ZSTD_createDStream(), ZSTD_freeDStream);
  std::string input(ZSTD_DStreamInSize(), '\0');
  std::string output(ZSTD_DStreamOutSize(), '\0');
  std::uint64_t position = 0;
  // Of a file that is cut off or damaged, what could be unpacked is there: its reader tells of the end that is missing.
  while (from.read(input.data(), static_cast<std::streamsize>(input.size())), from.gcount() > 0) {
    ZSTD_inBuffer in{input.data(), static_cast<std::size_t>(from.gcount()), 0};
    while (in.pos < in.size) {
      ZSTD_outBuffer out{output.data(), output.size(), 0};
      if (ZSTD_isError(ZSTD_decompressStream(stream.get(), &out, &in)) != 0) {
        return;
      }
      to.write(output.data(), static_cast<std::streamsize>(out.pos));
      position += out.pos;
    }
  }
  to.flush();
  if (!to) {
    throw FileError::ofSystem(unpacked, "cannot be written after " + std::to_string(position) + " bytes");
  }
}
#else
void decompressZstdFile(const std::filesystem::path& packed, const std::filesystem::path&)
{
  requireLibrary(Compression::zstd, {packed, "", 0});
}
#endif

}  // namespace pcl_floam
