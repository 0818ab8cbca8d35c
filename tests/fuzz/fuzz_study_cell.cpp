#include "host/study/study/study_store.h"
#include "tests/fuzz/fuzz_input.h"

// The cell.json of an earlier run of a study: it is taken whole or not at all, and never an error.

using namespace reradiant;

int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
    fuzz::put("cell.json", fuzz::text_of(bytes, size));
    CellResult cell;
    cell.folder = fuzz::folder();
    try {
        if (restore_cell(cell, "identity") && cell.measurement &&
            cell.measurement->matrix.rows() != cell.measurement->bands.count)
            fuzz::fail("a matrix of another size than its bands");
    } catch (const std::exception& error) {
        fuzz::fail(std::string("an exception instead of false: ") + error.what());
    }
    return 0;
}
