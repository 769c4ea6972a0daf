#include "ipc/igtl/stream.hpp"

#include <algorithm>

namespace tact {

std::span<std::byte> IgtlStream::room() noexcept {
    // After next() returned `more`, less than one message is left, so that half of the memory is free. After `lost` the
    // bytes are of no use.
    if (fault != IgtlHeaderFault::none) begin_ = end_;
    std::copy(bytes_.begin() + static_cast<std::ptrdiff_t>(begin_),
              bytes_.begin() + static_cast<std::ptrdiff_t>(end_), bytes_.begin());
    end_ -= begin_;
    begin_ = 0;
    body = {};
    return std::span(bytes_).subspan(end_);
}

void IgtlStream::add(std::size_t n) noexcept { end_ += std::min(n, bytes_.size() - end_); }

void IgtlStream::restart() noexcept {
    begin_ = end_ = 0;
    skip_ = 0;
    body = {};
    fault = IgtlHeaderFault::none;
}

IgtlStream::Next IgtlStream::next() noexcept {
    if (fault != IgtlHeaderFault::none) return Next::lost;
    const auto skipped = static_cast<std::size_t>(std::min<std::uint64_t>(skip_, end_ - begin_));
    skip_ -= skipped;
    begin_ += skipped;
    if (skip_ > 0 || end_ - begin_ < kIgtlHeaderBytes) return Next::more;
    const std::span<const std::byte> rest(bytes_.data() + begin_, end_ - begin_);
    fault = decode_header(rest.first<kIgtlHeaderBytes>(), header);
    if (fault != IgtlHeaderFault::none) return Next::lost;
    if (header.body_bytes > kIgtlBodyKept) {
        begin_ += kIgtlHeaderBytes;
        skip_ = header.body_bytes;
        body = {};
        return Next::skipped;
    }
    const auto bytes = static_cast<std::size_t>(header.body_bytes);
    if (rest.size() < kIgtlHeaderBytes + bytes) return Next::more;
    body = rest.subspan(kIgtlHeaderBytes, bytes);
    begin_ += kIgtlHeaderBytes + bytes;
    return Next::message;
}

}  // namespace tact
