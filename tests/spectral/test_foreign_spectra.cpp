#include "reradiant/spectral_files.h"
#include "tests/spectral/refusal.h"
#include "tests/support/scratch_folder.h"

using namespace reradiant;

namespace {

const std::string jcamp_head =
    "##TITLE= red tile\n##JCAMP-DX= 4.24 $$ made by hand\n"
    "##DATA TYPE= UV/VIS SPECTRUM\n##ORIGIN= a laboratory\n of two lines\n";
const std::string cgats_head = "CGATS.17\nORIGINATOR \"a lab\"\n# remark\nNUMBER_OF_FIELDS 5\n"
                               "BEGIN_DATA_FORMAT\n";

/// Spectra in formats of other programs, under any ending.
class ForeignSpectra : public test::ScratchFolder {
protected:
    Spectrum read(const std::string& text, const std::string& name = "s.csv") const {
        return read_spectrum(write(name, text));
    }
    std::pair<int, int> place(const std::string& text, const std::string& words = "") const {
        return refusal([&] { read(text); }, words);
    }
    static std::string jcamp(const std::string& records) {
        return jcamp_head + records + "##END=\n";
    }
};

/// Equidistant form: 400, 410 ... 450 nm in two lines, values 100 to 600 times YFACTOR.
std::string ordinates(const std::string& units = "REFLECTANCE", const std::string& more = "") {
    return "##XUNITS= NANOMETERS\n##YUNITS= " + units +
           "\n##XFACTOR= 0.1\n##YFACTOR= 0.001\n##FIRSTX= 400\n##LASTX= 450\n##NPOINTS= 6\n"
           "##DELTAX= 10\n" +
           more + "##XYDATA= (X++(Y..Y))\n4000 100 200 300\n4300 400 500 600\n";
}

std::string tm27(const std::string& body) {
    return "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<IESTM2714 xmlns=\"iestm2714\" "
           "version=\"1.0\">\n<Header><Description>lamp</Description></Header>\n"
           "<SpectralDistribution>\n" +
           body + "</SpectralDistribution>\n</IESTM2714>\n";
}

} // namespace

TEST_F(ForeignSpectra, JcampEquidistantValuesAndFactors) {
    for (const char* name : {"s.jdx", "s.dx", "s.csv", "s.spd", "s"}) {
        const Spectrum spectrum = read(jcamp(ordinates()), name);
        for (int k = 0; k < 6; ++k)
            EXPECT_NEAR(spectrum(400 + 10 * k), 0.1 * (k + 1), 1e-12) << name;
    }
    EXPECT_NEAR(read(jcamp(ordinates("PERCENT TRANSMITTANCE")))(450), 0.006, 1e-12);
    EXPECT_NEAR(read(jcamp(ordinates("REFLECTANCE", "##FIRSTY= 0.1\n")))(400), 0.1, 1e-12);
    // AFFN takes exponents and signs; labels any case, blanks and strokes.
    const std::string small = "##xunits=micrometers\n##Y UNITS=Transmittance\n##first-x=0.5\n"
                              "##LAST_X=0.4\n##NPOINTS=3\n##XYDATA=(X++(Y..Y))\n"
                              "0.5 +1.0E-1 0.2\n0.4 3e-1\n";
    EXPECT_NEAR(read(jcamp(small))(400), 0.3, 1e-12);
    EXPECT_NEAR(read(jcamp(small))(450), 0.2, 1e-12);
}

TEST_F(ForeignSpectra, JcampWavenumbersAscendAsWavelengths) {
    const Spectrum spectrum =
        read(jcamp("##XUNITS= 1/CM\n##YUNITS= REFLECTANCE\n##FIRSTX= 16000\n##LASTX= 25000\n"
                   "##NPOINTS= 4\n##XYDATA= (X++(Y..Y))\n16000 0.1 0.2\n22000 0.3 0.4\n"));
    EXPECT_NEAR(spectrum(625), 0.1, 1e-12);
    EXPECT_NEAR(spectrum(1e7 / 19000), 0.2, 1e-12);
    EXPECT_NEAR(spectrum(400), 0.4, 1e-12);
}

TEST_F(ForeignSpectra, JcampPairs) {
    const std::string units = "##XUNITS= NANOMETERS\n##YUNITS= REFLECTANCE\n##YFACTOR= 0.01\n";
    for (const char* pairs : {"400, 10; 500, 30\n600, 50\n", "400 10\n500 30\n600 50\n",
                              "400,10 500,30\n600,50 $$ the end\n"})
        for (const char* label : {"XYPOINTS", "XYDATA"}) {
            const Spectrum spectrum = read(jcamp(units + "##" + label + "= (XY..XY)\n" + pairs));
            EXPECT_NEAR(spectrum(550), 0.4, 1e-12) << pairs;
        }
    EXPECT_EQ(place(jcamp(units + "##XYPOINTS= (XY..XY)\n400 10 500\n"), "without its Y"),
              (std::pair{10, 8}));
    EXPECT_EQ(place(jcamp(units + "##XYPOINTS= (XY..XY)\n400 10\n400 11\n"), "twice").first, 11);
}

TEST_F(ForeignSpectra, Case35JcampThatIsNotUnderstoodIsRefusedByName) {
    const std::string points = "##XUNITS= NANOMETERS\n##YUNITS= REFLECTANCE\n##FIRSTX= 400\n"
                               "##LASTX= 420\n##NPOINTS= 3\n##XYDATA= (X++(Y..Y))\n";
    for (const char* packed : {"400+1+2+3\n", "400A0B1C2\n", "400 A1J2K3\n", "400@VKT%TLk\n"})
        EXPECT_EQ(place(jcamp(points + packed), "PAC, SQZ").first, 12) << packed;
    EXPECT_EQ(place(jcamp(points + "400 1 ?  2\n"), "missing").first, 12);
    EXPECT_EQ(place(jcamp(points + "400 0.1 0.2\n"), "2 values where NPOINTS says 3").second, 1);
    EXPECT_EQ(place(jcamp(points + "400 0.1\n420 0.3\n"), "410 is due"), (std::pair{13, 1}));
    EXPECT_EQ(place(jcamp(points + "400 1 2 3 4 5 6 7\n"), "NPOINTS says 3").second, 1);
    EXPECT_EQ(place(jcamp_head + points + "400 1 2 3\n", "cut off").second, 1);
    EXPECT_EQ(place(jcamp(points + "400 1 2 3\n") + jcamp(points), "second block").first, 14);
    EXPECT_EQ(place(jcamp(ordinates("ABSORBANCE")), "ABSORBANCE"), (std::pair{7, 11}));
    EXPECT_EQ(place(jcamp(ordinates("KUBELKA-MUNK")), "KUBELKA").first, 7);
    EXPECT_EQ(place(jcamp(ordinates("LOG(1/REFLECTANCE)")), "LOG").first, 7);
    EXPECT_EQ(place(jcamp(ordinates("ARBITRARY UNITS")), "ARBITRARY").first, 7);
    EXPECT_EQ(place(jcamp(ordinates("REFLECTANCE", "##FIRSTY= 100\n")), "FIRSTY").first, 14);
    EXPECT_EQ(place(jcamp("##XUNITS= SECONDS\n##YUNITS= REFLECTANCE\n##XYDATA= (XY..XY)\n1 2\n"),
                    "SECONDS"),
              (std::pair{6, 11}));
    EXPECT_EQ(place(jcamp("##YUNITS= REFLECTANCE\n##XYDATA= (XY..XY)\n400 2\n"), "XUNITS").second,
              1);
    EXPECT_EQ(place(jcamp("##PEAK TABLE= (XY..XY)\n400 2\n"), "PEAKTABLE").first, 6);
    EXPECT_EQ(place(jcamp("##NTUPLES= MASS\n"), "NTUPLES").first, 6);
    EXPECT_EQ(place(jcamp("##XUNITS= NANOMETERS\n##YUNITS= REFLECTANCE\n##XYDATA= (X++(R..R))\n"),
                    "(X++(R..R))")
                  .first,
              8);
    place(jcamp(""), "no ##XYDATA");
}

TEST_F(ForeignSpectra, JcampIsKnownBehindWhatProgramsWriteAboveIt) {
    const std::string text = jcamp(ordinates("TRANSMITTANCE PER CENT"));
    for (const char* above : {"", "$$ Exported by X\n", "# c\n", "x\n", "\n\n; c\n400,0.5\n"})
        EXPECT_NEAR(read(above + text)(450), 0.006, 1e-12) << above;
    EXPECT_EQ(read("## author=me\nnm,value\n400,0.5\n500,0.7\n")(450), 0.6);
    EXPECT_EQ(read("##author=me\nnm,value\n400,0.5\n500,0.7\n")(450), 0.6);
}

TEST_F(ForeignSpectra, JcampQuantitiesAndToldValuesAreChecked) {
    for (const char* units : {"1-TRANSMITTANCE", "KUBELKA-MUNK (REFLECTANCE)", "SQRT REFLECTANCE",
                              "1/REFLECTANCE", "REFLECTANCE X 100"})
        EXPECT_EQ(place(jcamp(ordinates(units)), "YUNITS are"), (std::pair{7, 11})) << units;
    for (const char* units : {"REFLECTANCE", "TOTAL REFLECTANCE", "Reflectance Factor"})
        EXPECT_NEAR(read(jcamp(ordinates(units, "##MAXY= 0.6\n##MINY= 0.1\n")))(450), 0.6, 1e-12)
            << units;
    EXPECT_EQ(place(jcamp(ordinates("REFLECTANCE", "##MAXY= 0.006\n")), "MAXY"),
              (std::pair{14, 9}));
    EXPECT_EQ(place(jcamp(ordinates("REFLECTANCE", "##MINY= 0.5\n")), "MINY").first, 14);
    // No YFACTOR, and values that need one.
    const std::string head = "##XUNITS= NANOMETERS\n##YUNITS= REFLECTANCE\n##FIRSTX= 400\n"
                             "##LASTX= 410\n##NPOINTS= 2\n";
    const std::string data = "##XYDATA= (X++(Y..Y))\n400 1 2\n";
    EXPECT_EQ(place(jcamp(head + "##FIRSTY= 0.5\n" + data), "FIRSTY").first, 11);
    EXPECT_EQ(read(jcamp(head + "##FIRSTY= 1\n" + data))(405), 1.5);
}

TEST_F(ForeignSpectra, CgatsFieldsOfOneSample) {
    for (const char* field :
         {"SPECTRAL_NM", "SPECTRAL_NM_", "SPECTRAL_", "SPEC_", "nm", "nm_", "R_"}) {
        const std::string f = field;
        const Spectrum spectrum =
            read(cgats_head + "SAMPLE_ID SAMPLE_NAME " + f + "400 " + f + "500\n" + f +
                 "600\nEND_DATA_FORMAT\nNUMBER_OF_SETS 1\n"
                 "BEGIN_DATA\n1 \"red paint\" 0.1\n0.3 0.5\nEND_DATA\n");
        EXPECT_NEAR(spectrum(550), 0.4, 1e-12) << f;
    }
    EXPECT_NEAR(read("SPECT   \n\nSPECTRAL_NORM \"100.0\"\nBEGIN_DATA_FORMAT\nSPEC_400 SPEC_500\n"
                     "END_DATA_FORMAT\nBEGIN_DATA\n10 30\nEND_DATA\n",
                     "s.sp")(450),
                0.2, 1e-12);
    EXPECT_NEAR(read(cgats_head + "SPECTRAL_NM SPECTRAL_PCT SPECTRAL_NM SPECTRAL_DEC\n"
                                  "END_DATA_FORMAT\nBEGIN_DATA\n500 30 400 0.1\nEND_DATA\n")(450),
                0.2, 1e-12);
}

TEST_F(ForeignSpectra, Case35CgatsThatHoldsNoneOrManyIsRefused) {
    const std::string fields = "SAMPLE_ID NM_400 NM_500\nEND_DATA_FORMAT\n";
    EXPECT_EQ(place(cgats_head + fields + "BEGIN_DATA\n1 0.1 0.3\n2 0.2 0.4\nEND_DATA\n",
                    "2 sets of data")
                  .first,
              8);
    EXPECT_EQ(place(cgats_head + fields + "BEGIN_DATA\n1 0.1\nEND_DATA\n", "2 values for 3").first,
              9);
    EXPECT_EQ(place(cgats_head + fields + "BEGIN_DATA\n1 0.1 x\nEND_DATA\n", "'x'"),
              (std::pair{9, 7}));
    place(cgats_head + fields + "BEGIN_DATA\n1 0.1 0.2\n", "END_DATA is missing");
    place(cgats_head + "SAMPLE_ID XYZ_X\nEND_DATA_FORMAT\nBEGIN_DATA\n1 2\nEND_DATA\n",
          "no field holds a spectrum");
    place("CGATS.17\n", "no data");
}

TEST_F(ForeignSpectra, Tm27) {
    const std::string data = "<SpectralData wavelength=\"400\">0.1</SpectralData>\n"
                             "<SpectralData wavelength=\" 500.0 \"> 3e-1 </SpectralData>\n";
    for (const char* name : {"s.spdx", "s.xml", "s.csv"})
        EXPECT_NEAR(read(tm27("<SpectralQuantity>relative</SpectralQuantity>\n" + data), name)(450),
                    0.2, 1e-12);
    EXPECT_EQ(place(tm27("<SpectralData wavelength=\"400\">x</SpectralData>\n"), "'x'"),
              (std::pair{5, 1}));
    EXPECT_EQ(place(tm27("<SpectralData>1</SpectralData>\n"), "missing").first, 5);
    EXPECT_EQ(place(tm27(""), "no SpectralData").first, 4);
    EXPECT_EQ(place(tm27("<SpectralQuantity>other</SpectralQuantity>\n" + data), "'other'").first,
              5);
    EXPECT_EQ(place(tm27(data).substr(0, 260), "not valid XML").second > 0, true);
    EXPECT_EQ(place("<IESTM2714/>", "no SpectralDistribution"), (std::pair{1, 1}));
}

TEST_F(ForeignSpectra, CgatsWordsInAnyCaseAndInTheirPlace) {
    const std::string data = "BEGIN_DATA_FORMAT\nSPECTRAL_NM400nm SPECTRAL_NM500nm\n"
                             "END_DATA_FORMAT\nBEGIN_DATA\n10 30\nEND_DATA\n";
    EXPECT_NEAR(read("CGATS.17\nspectral_norm 100\n" + data)(450), 0.2, 1e-12);
    EXPECT_EQ(place("CGATS.17\n" + data + "SPECTRAL_NORM 100\n", "behind the data"),
              (std::pair{8, 15}));
    EXPECT_EQ(place("CGATS.17\nBEGIN_DATA_FORMAT\nSPEC_400 SPEC_5OO\nEND_DATA_FORMAT\n"
                    "BEGIN_DATA\n1 3\nEND_DATA\n",
                    "not a number"),
              (std::pair{3, 10}));
}

TEST_F(ForeignSpectra, Tm27ValuesAreTheWholeTextOfAnElement) {
    EXPECT_EQ(read(tm27("<SpectralData wavelength=\"400\">0.<!-- x -->5</SpectralData>\n"))(400),
              0.5);
    EXPECT_EQ(place(tm27("<SpectralData wavelength=\"400\">0.5<b/></SpectralData>\n"), "more than"),
              (std::pair{5, 1}));
}

TEST_F(ForeignSpectra, Case35TextsOfNumbersThatAreNoTableAreRefused) {
    const std::pair<const char*, const char*> heads[] = {
        {"%!PS", "PostScript"},
        {"P3", "PPM"},
        {"OFF", "OFF"},
        {"ply\nformat ascii 1.0", "PLY"},
        {"ply\r\nformat ascii 1.0", "PLY"},
        {"ISO-10303-21;", "STEP"},
        {"%%MatrixMarket matrix array real general", "Matrix Market"}};
    for (const auto& [head, words] : heads)
        EXPECT_EQ(place(std::string(head) + "\n400 0.1\n500 0.2\n", words), (std::pair{1, 1}));
    EXPECT_EQ(read("OFF-white\nnm,R\n400,0.1\n500,0.2\n")(400), 0.1);
}

TEST_F(ForeignSpectra, Case35WhatIsNoTextIsRefusedByWhatItIs) {
    const std::string zip("PK\x03\x04\x14\0\x06\0", 8);
    const std::pair<std::string, const char*> files[] = {
        {zip, "Zip"},
        {"\xd0\xcf\x11\xe0\xa1\xb1\x1a\xe1", "OLE2"},
        {"%PDF-1.7\n", "PDF"},
        {"\x76\x2f\x31\x01\x02", "OpenEXR"},
        {"\x89PNG\r\n", "PNG"},
        {std::string("\xff\xfe"
                     "4\0000\0000\0",
                     8),
         "UTF-16"},
        {std::string("\xfe\xff\0004", 4), "UTF-16"},
        {std::string("4\0000\0000\0,\0001\0", 10), "UTF-16"},
        {std::string("\xff\xfe\0\0"
                     "4\0\0\0",
                     8),
         "UTF-32"},
        {std::string("400,0.1\n500,\0000.2\n", 18), "NUL"},
        {"\x1f\x8b\x08", "gzip"},
        {"<!DOCTYPE html>\n<html><p>400,0.1</p>\n400,0.1\n", "HTML"},
        {"<html>\n400,0.1\n", "HTML"},
        {"<?xml version=\"1.0\"?>\n<scene/>\n400,0.1\n", "XML"},
        {"{\"nm\": [\n400,0.1\n500,0.2\n]}", "JSON"},
        {"[400,\n0.1]\n", "JSON"},
        {"IESNA:LM-63-2002\n[TEST]\nTILT=NONE\n1 1000\n", "LM-63"},
        {"VEC_01\t5167\nBFC-450 Matrix File\n400 1\n", "BFC-450"},
    };
    for (const auto& [bytes, words] : files) {
        for (const char* name : {"s.csv", "s.spd", "s.txt"})
            refusal([&] { read(bytes, name); }, words);
        refusal([&] { read_reradiation(write("m.csv", bytes)); }, words);
    }
    for (const std::string& text :
         {jcamp(ordinates()), cgats_head + "SPEC_400\nEND_DATA_FORMAT\n", tm27("")})
        refusal([&] { read_reradiation(write("m.csv", text)); }, "where a spectrum is asked for");
    refusal([&] { read_reradiation(write("m.bfc", "nm,400\n400,1\n")); }, "BFC-450");
    EXPECT_FALSE(holds_reradiation(write("s.csv", jcamp(ordinates()))));
}
