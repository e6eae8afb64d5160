// SPDX-License-Identifier: GPL-3.0-or-later
#include "exactvo/datasets/provenance.h"

#include <cstdlib>

#include "refusal.h"
#include "temporary_folder.h"

namespace exactvo::datasets::test {
namespace {

using ProvenanceTest = TemporaryFolder;

// FIPS 180-4's own examples, and the lengths round a block's edge against a second implementation (coreutils).
TEST(Sha256, AgreesWithPublishedValues) {
  EXPECT_EQ(sha256_of(""), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
  EXPECT_EQ(sha256_of("abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  EXPECT_EQ(sha256_of("abcdbcdecdefdefgefghfghighijhijkijkljklmklmnlmnomnopnopq"),
            "248d6a61d20638b8e5c026930c3e6039a33ce45964ff2167f6ecedd419db06c1");
  EXPECT_EQ(sha256_of(std::string(1000000, 'a')), "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0");
}

TEST(Sha256, AgreesRoundTheEdgeOfABlock) {
  EXPECT_EQ(sha256_of(std::string(55, 'a')), "9f4390f8d30c2dd92ec9f095b65e2b9ae9b0a925a5258e241c9f1e910f734318");
  EXPECT_EQ(sha256_of(std::string(56, 'a')), "b35439a4ac6f0948b6d6f9e3c6af0f5f590ce20f1bde7090ef7970686ec6738a");
  EXPECT_EQ(sha256_of(std::string(63, 'a')), "7d3e74a05d7db15bce4ad9ec0658ea98e3f06eeecf16b4c6fff2da457ddc2f34");
  EXPECT_EQ(sha256_of(std::string(64, 'a')), "ffe054fe7ae0cb6dc65c3af9b61d5209f439851db43d0ba5997337df154668eb");
  EXPECT_EQ(sha256_of(std::string(65, 'a')), "635361c48bb9eab14198e76ea8ab7f1a41685d6ad62aa9146d301d4f17eb0ae0");
}

TEST_F(ProvenanceTest, AFileHashesAsItsBytes) {
  const std::string bytes(200001, 'z');
  EXPECT_EQ(sha256_of_file(put("bytes", bytes)), sha256_of(bytes));
}

TEST_F(ProvenanceTest, ReadsBackWhatItWrote) {
  const auto input = put("map.wkt", "POINT EMPTY");
  const Provenance p = make_provenance({"exactvo", "simulate", "a \"b\"\n\\c"}, 18446744073709551615u, {input});
  const Provenance q = parse_provenance(to_json(p), "p.json");
  EXPECT_EQ(to_json(q), to_json(p));
  EXPECT_EQ(q.command_line, p.command_line);
  EXPECT_EQ(q.seed, 18446744073709551615u);
  ASSERT_EQ(q.inputs.size(), 1u);
  EXPECT_EQ(q.inputs[0].sha256, sha256_of("POINT EMPTY"));
}

TEST_F(ProvenanceTest, KnowsItsBuild) {
  const Provenance p = make_provenance({"exactvo"}, 1);
  for (const std::string& fact : {p.version, p.commit, p.compiler, p.build_type, p.cgal, p.gmp, p.gdal}) {
    EXPECT_FALSE(fact.empty());
  }
}

TEST_F(ProvenanceTest, Property1_OnlyTheTimeDiffers) {
  ::setenv("SOURCE_DATE_EPOCH", "1700000000", 1);
  const Provenance early = make_provenance({"exactvo"}, 1);
  ::setenv("SOURCE_DATE_EPOCH", "1700000001", 1);
  Provenance late = make_provenance({"exactvo"}, 1);
  ::unsetenv("SOURCE_DATE_EPOCH");
  EXPECT_EQ(early.written_at, "2023-11-14T22:13:20Z");
  EXPECT_NE(to_json(early), to_json(late));
  late.written_at = early.written_at;
  EXPECT_EQ(to_json(early), to_json(late));
}

TEST_F(ProvenanceTest, AMissingInputIsNamed) {
  const DataError error = refusal_of([&] { make_provenance({}, 0, {folder_ / "none"}); });
  EXPECT_EQ(error.code(), DataCode::file_missing);
  EXPECT_EQ(error.file(), (folder_ / "none").string());
}

TEST_F(ProvenanceTest, ForeignJsonIsRefused) {
  EXPECT_EQ(refusal_of([] { parse_provenance("{}", "p.json"); }).file(), "p.json");
  EXPECT_EQ(refusal_of([] { parse_provenance("{", "p.json"); }).code(), DataCode::json_syntax);
}

}  // namespace
}  // namespace exactvo::datasets::test
