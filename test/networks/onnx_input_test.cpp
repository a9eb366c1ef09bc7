#include "networks/onnx_input.hpp"

#include <stdexcept>

#include <gmock/gmock.h>

#include "evaluation/message_of.hpp"
#include "networks/onnx_model.hpp"

namespace fast_edi {
namespace {

using ::testing::HasSubstr;

std::string faultOf(const std::string& model) {
  return messageOf<std::runtime_error>([&] { onnxInput(model); });
}

std::string modelWithInputs(const std::vector<ProtoMessage>& inputs) {
  ProtoMessage graph = ProtoMessage().text(2, "graph");
  for (const ProtoMessage& input : inputs) {
    graph.message(11, input);
  }
  return ProtoMessage().message(7, graph).bytes();
}

TEST(OnnxInputTest, ReadsChannelsAndSize) {
  ConvolutionModel model;
  model.channels = 3;
  model.height = 260;
  model.width = 346;
  const OnnxInput input = onnxInput(model.bytes());
  EXPECT_EQ(input.channels, 3);
  EXPECT_EQ(input.height, 260);
  EXPECT_EQ(input.width, 346);
}

TEST(OnnxInputTest, NamedSizesAreAny) {
  const OnnxInput input = onnxInput(ConvolutionModel().bytes());
  EXPECT_EQ(input.channels, 1);
  EXPECT_EQ(input.height, 0);
  EXPECT_EQ(input.width, 0);
}

TEST(OnnxInputTest, WeightsAreNoInputsEvenWhereTheyAreListed) {
  ConvolutionModel model;
  model.weights_among_inputs = true;
  EXPECT_EQ(onnxInput(model.bytes()).channels, 1);
}

TEST(OnnxInputTest, SaysWhatIsWrong) {
  EXPECT_THAT(faultOf(""), HasSubstr("not an ONNX model"));
  EXPECT_THAT(faultOf("a text that is no model"), HasSubstr("not an ONNX model"));
  EXPECT_THAT(faultOf(modelWithInputs({})), HasSubstr("it has 0 inputs, expected one image"));
  EXPECT_THAT(faultOf(modelWithInputs({valueInfo("a", {1, 1, 8, 8}), valueInfo("b", {1})})),
              HasSubstr("it has 2 inputs"));
  EXPECT_THAT(faultOf(modelWithInputs({valueInfo("a", {1, 512})})),
              HasSubstr("its input has 2 dimensions, expected four"));
}

TEST(OnnxInputTest, EveryCutIsRefusedOrReadWithoutOverrun) {
  const std::string whole = ConvolutionModel().bytes();
  for (std::size_t size = 0; size < whole.size(); ++size) {
    try {
      EXPECT_EQ(onnxInput(whole.substr(0, size)).channels, 1) << "the graph is whole by then";
    } catch (const std::runtime_error& error) {
      EXPECT_STRNE(error.what(), "");
    }
  }
}

}  // namespace
}  // namespace fast_edi
