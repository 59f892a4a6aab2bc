#include "viewer/shader_sources.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "scene/error.h"
#include "support/shader_folder.h"

namespace airlight::viewer {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::UnorderedElementsAre;
using tests::EnvironmentValue;
using tests::ShaderFolder;

std::string error_of(const ShaderSources& sources) {
  try {
    sources.compile_changes();
  } catch (const scene::Error& error) {
    return error.what();
  }
  return "no error";
}

TEST(ShaderSources, ChangeWithWhatTheyInclude) {
  const ShaderFolder folder;
  ShaderSources sources(folder.path());
  EXPECT_TRUE(sources.compile_changes().names.empty());
  // Through another include.
  folder.write("media/table_place.glsl", folder.read("media/table_place.glsl") + "\n");
  const ShaderSources::Changes changes = sources.compile_changes();
  EXPECT_THAT(changes.names, UnorderedElementsAre("media/vsv_table.frag", "media/vsv_table_build.comp"));
  ASSERT_EQ(changes.words.size(), 2u);
  for (const auto& [embedded, words] : changes.words) {
    // An empty line changes nothing: the same compiler makes the same words.
    EXPECT_TRUE(std::equal(words.begin(), words.end(), embedded));
  }
  EXPECT_EQ(sources.compile_changes().names.size(), 2u) << "until they are accepted";
  sources.accept(changes);
  EXPECT_TRUE(sources.compile_changes().names.empty());
}

TEST(ShaderSources, SayWhatDoesNotCompile) {
  const ShaderFolder folder;
  ShaderSources sources(folder.path());
  const std::string sound = folder.read("viewer/tone_map.glsl");
  folder.write("viewer/tone_map.glsl", "\nfloat broken = missing;\n" + sound);
  EXPECT_THAT(error_of(sources), AllOf(HasSubstr("viewer/develop.frag: it does not compile\n"),
                                       HasSubstr("ERROR: viewer/tone_map.glsl:2: 'missing'")));
  EXPECT_THAT(error_of(sources), HasSubstr("does not compile")) << "until it is mended";
  folder.write("viewer/tone_map.glsl", sound);
  EXPECT_THAT(sources.compile_changes().names, ElementsAre("viewer/develop.frag"));
  folder.replace("viewer/develop.frag", "layout(constant_id = 1) ", "");
  EXPECT_THAT(error_of(sources), AllOf(HasSubstr("viewer/develop.frag"), HasSubstr("constant 1")));
}

TEST(ShaderSources, SayWhatIsMissing) {
  EXPECT_THAT(error_of(ShaderSources("/nowhere")), HasSubstr("AIRLIGHT_SHADERS"));
  const ShaderFolder folder;
  const ShaderSources sources(folder.path() / "");
  folder.replace("viewer/develop.frag", "clamp", "min(linear, 1.0) + 0.0 * clamp");
  const EnvironmentValue no_programs("PATH", "/nowhere");
  EXPECT_THAT(error_of(sources), HasSubstr("glslangValidator, which compiles them, is not installed"));
}

}  // namespace
}  // namespace airlight::viewer
