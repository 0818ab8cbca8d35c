#include "host/render/dyes/dyed_file.h"

#include "host/base/atomic_file.h"
#include "host/base/checksum.h"
#include "host/base/logging.h"
#include "host/base/regular_file.h"
#include "reradiant/error.h"
#include "reradiant/paths.h"

#include <fmt/core.h>

#include <algorithm>
#include <string_view>
#include <vector>

namespace reradiant {

namespace fs = std::filesystem;

namespace {

constexpr std::string_view magic = "RRDYES1\n";
/// Magic word, key, checksum of the numbers.
constexpr std::size_t header_size = magic.size() + 64 + 16;

std::string_view bytes_of(const std::vector<double>& numbers) {
    return {reinterpret_cast<const char*>(numbers.data()), numbers.size() * sizeof(double)};
}

std::string header_of(const std::string& key, const std::vector<double>& numbers) {
    return fmt::format("{}{}{:016x}", magic, key, checksum_of(numbers));
}

/// The numbers of an operator one after the other. `visit` receives each, to write or to read it.
template <typename Operator, typename Visit>
void visit_numbers(Operator& dyes, const Visit& visit) {
    visit(dyes.channels);
    visit(dyes.cells);
    visit(dyes.depth_error);
    visit(dyes.channel_error);
    visit(dyes.shifts_up);
    visit(dyes.terms);
    visit(dyes.factor_error);
    visit.list(dyes.phases, [&](auto& phase) {
        visit.list(phase.reached, [&](auto& lane) { visit.matrix(lane); });
        visit.matrix(phase.coupling);
        visit.matrix(phase.factors.within);
        visit.matrix(phase.factors.sent);
        visit.matrix(phase.factors.taken);
        visit(phase.factors.error);
    });
}

class NumberWriter {
public:
    explicit NumberWriter(std::vector<double>& numbers) : numbers_(numbers) {}

    template <typename T>
    void operator()(const T& value) const {
        numbers_.push_back(static_cast<double>(value));
    }
    void matrix(const Eigen::MatrixXd& matrix) const {
        (*this)(matrix.rows());
        (*this)(matrix.cols());
        numbers_.insert(numbers_.end(), matrix.data(), matrix.data() + matrix.size());
    }
    template <typename T, typename Visit>
    void list(const std::vector<T>& items, const Visit& visit) const {
        (*this)(items.size());
        for (const T& item : items)
            visit(item);
    }

private:
    std::vector<double>& numbers_;
};

/// Reads what a NumberWriter wrote, whose checksum was found to be right.
class NumberReader {
public:
    explicit NumberReader(const std::vector<double>& numbers) : next_(numbers.data()) {}

    template <typename T>
    void operator()(T& value) const {
        value = static_cast<T>(*next_++);
    }
    void matrix(Eigen::MatrixXd& matrix) const {
        Eigen::Index rows = 0, columns = 0;
        (*this)(rows);
        (*this)(columns);
        matrix = Eigen::Map<const Eigen::MatrixXd>(next_, rows, columns);
        next_ += matrix.size();
    }
    template <typename T, typename Visit>
    void list(std::vector<T>& items, const Visit& visit) const {
        std::size_t count = 0;
        (*this)(count);
        items.resize(count);
        for (T& item : items)
            visit(item);
    }

private:
    mutable const double* next_;
};

fs::path file_of(const std::string& key) {
    return dyed_folder() / (key + ".bin");
}

struct KeptFile {
    fs::file_time_type used;
    std::uintmax_t bytes;
    fs::path file;
};

/// Removes files that were used longest ago until the others take no more than so many bytes.
void remove_oldest(std::uintmax_t most_bytes) {
    std::vector<KeptFile> kept;
    std::uintmax_t bytes = 0;
    for (const fs::directory_entry& entry : fs::directory_iterator(dyed_folder())) {
        std::error_code gone; // by another process
        const KeptFile file{entry.last_write_time(gone), entry.file_size(gone), entry.path()};
        if (gone || entry.path().extension() != ".bin")
            continue;
        bytes += file.bytes;
        kept.push_back(file);
    }
    std::ranges::sort(kept, {}, &KeptFile::used);
    for (const KeptFile& oldest : kept) {
        if (bytes <= most_bytes)
            return;
        std::error_code ignored;
        fs::remove(oldest.file, ignored);
        bytes -= oldest.bytes;
    }
}

void write_dyed_file(const std::string& key, const std::vector<double>& numbers) {
    fs::create_directories(dyed_folder());
    write_atomically(file_of(key), [&](const fs::path& temporary) {
        std::ofstream out(temporary, std::ios::binary);
        out << header_of(key, numbers) << bytes_of(numbers);
        out.close();
        if (!out)
            throw_runtime_error(temporary.string() + " cannot be written");
    });
}

} // namespace

fs::path dyed_folder() {
    return cache_directory() / "dyes";
}

std::optional<DyedOperator> read_dyed_file(const std::string& key) {
    const fs::path file = file_of(key);
    std::error_code none;
    const std::uintmax_t size = fs::file_size(file, none);
    if (none)
        return std::nullopt;
    std::string header(header_size, '\0');
    std::vector<double> numbers(
        size > header_size && size <= most_dyed_bytes ? (size - header_size) / sizeof(double) : 0);
    std::ifstream in = open_regular_file(file);
    in.read(header.data(), static_cast<std::streamsize>(header.size()));
    in.read(reinterpret_cast<char*>(numbers.data()),
            static_cast<std::streamsize>(numbers.size() * sizeof(double)));
    const bool whole = in.good() && in.peek() == std::ifstream::traits_type::eof();
    if (!whole || header != header_of(key, numbers)) {
        logging::warn("{}: damaged cache file; it is computed again", file.string());
        return std::nullopt;
    }
    fs::last_write_time(file, fs::file_time_type::clock::now(), none);
    DyedOperator dyes;
    visit_numbers(dyes, NumberReader(numbers));
    return dyes;
}

void keep_dyed_operator(const std::string& key, const DyedOperator& dyes,
                        std::uintmax_t most_bytes) {
    std::vector<double> numbers;
    visit_numbers(dyes, NumberWriter(numbers));
    if (header_size + bytes_of(numbers).size() > most_bytes / 4)
        return;
    try {
        write_dyed_file(key, numbers);
        remove_oldest(most_bytes);
    } catch (const std::exception& error) {
        logging::debug("cache of dyes not written: {}", error.what());
    }
}

} // namespace reradiant
