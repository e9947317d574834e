//! The layers of a network: weights and biases from a safetensors file, checked against each other.

use std::collections::BTreeSet;

use safetensors::tensor::TensorView;
use safetensors::{Dtype, SafeTensors};
use serde::Deserialize;
use xt28_rosbridge::printable;

/// Most weights of a network: some 2 ms of a tick of 10 ms (measured by hand: 27 ms for 49 million).
const SIZE_MAX: usize = 4_000_000;

/// What each layer but the last does to its numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "lowercase")]
pub(super) enum Activation {
    Elu,
    Relu,
    Silu,
    Tanh,
}

/// What is done to the numbers of the last one.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "lowercase")]
pub(super) enum Squash {
    None,
    Tanh,
}

/// Fully connected layers, one behind the other.
#[derive(Clone, Debug)]
pub(super) struct Layers {
    layers: Vec<Layer>,
    activation: Activation,
    squash: Squash,
    /// What goes into a layer and comes out of it.
    between: [Vec<f32>; 2],
}

/// `outputs = weights * inputs + bias`.
#[derive(Clone, Debug)]
struct Layer {
    inputs: usize,
    /// A row for each output.
    weights: Vec<f32>,
    /// One for each output.
    bias: Vec<f32>,
}

impl Activation {
    fn of(self, x: f32) -> f32 {
        match self {
            Self::Elu if x < 0.0 => libm::expm1f(x),
            Self::Elu => x,
            // What is no number stays none.
            Self::Relu if x < 0.0 => 0.0,
            Self::Relu => x,
            Self::Silu => x / (1.0 + libm::expf(-x)),
            Self::Tanh => libm::tanhf(x),
        }
    }
}

impl Layers {
    /// The layers `names` of the file `bytes`, the first to be fed with `inputs` numbers, the last to say `outputs`. Each
    /// is a pair of tensors, `NAME.weight` (outputs by inputs) and `NAME.bias`.
    ///
    /// # Errors
    /// What is wrong with which tensor, and what would be right.
    pub(super) fn read(
        bytes: &[u8],
        names: &[String],
        [inputs, outputs]: [usize; 2],
        (activation, squash): (Activation, Squash),
    ) -> Result<Self, String> {
        let file = SafeTensors::deserialize(bytes)
            .map_err(|error| printable(&format!("no safetensors file: {error}")))?;
        let mut layers: Vec<Layer> = Vec::new();
        let mut fed_by = ("what the [[input]] tables come to".to_owned(), inputs);
        for name in names {
            let layer = Layer::read(&file, name)?;
            if layer.inputs != fed_by.1 {
                return Err(format!(
                    "{name}.weight takes {} numbers, but {} are {}; is a term, a frame or a layer missing?",
                    layer.inputs, fed_by.0, fed_by.1
                ));
            }
            fed_by = (format!("those that {name} gives"), layer.bias.len());
            layers.push(layer);
        }
        let weights: usize = layers.iter().map(|layer| layer.weights.len()).sum();
        if weights > SIZE_MAX {
            return Err(format!(
                "{weights} weights are too many for a tick of 10 ms; {SIZE_MAX} at most"
            ));
        }
        if fed_by.1 != outputs {
            let [said, given] = [&fed_by.0, &fed_by.1.to_string()];
            return Err(format!("an action is {outputs} numbers, but {said} are {given}"));
        }
        Ok(Self { layers, activation, squash, between: [Vec::new(), Vec::new()] })
    }

    /// What they make of `fed`. NaN where numbers grow beyond all bounds, which no safety kernel lets through.
    pub(super) fn forward(&mut self, fed: &[f32]) -> &[f32] {
        let [given, taken] = &mut self.between;
        given.clear();
        given.extend_from_slice(fed);
        for (k, layer) in self.layers.iter().enumerate() {
            let is_last = k + 1 == self.layers.len();
            let act = |x: f32| match self.squash {
                _ if !is_last => self.activation.of(x),
                Squash::Tanh => libm::tanhf(x),
                Squash::None => x,
            };
            taken.clear();
            taken.extend(layer.outputs(given).map(act));
            core::mem::swap(given, taken);
        }
        given
    }
}

impl Layer {
    fn read(file: &SafeTensors<'_>, name: &str) -> Result<Self, String> {
        let [weight, bias] = [format!("{name}.weight"), format!("{name}.bias")];
        let (shape, weights) = numbers(file, &weight)?;
        let [outputs, inputs] = shape[..] else {
            return Err(format!("{weight} has the shape {shape:?}; give outputs by inputs"));
        };
        let (shape, bias_values) = numbers(file, &bias)?;
        if shape != [outputs] {
            return Err(format!(
                "{bias} has the shape {shape:?}, but {weight} gives {outputs} numbers"
            ));
        }
        Ok(Self { inputs, weights, bias: bias_values })
    }

    fn outputs(&self, given: &[f32]) -> impl Iterator<Item = f32> {
        let rows = self.weights.chunks_exact(self.inputs.max(1));
        rows.zip(&self.bias).map(move |(row, bias)| {
            bias + row.iter().zip(given).map(|(weight, number)| weight * number).sum::<f32>()
        })
    }
}

/// Shape and numbers of a tensor, every one of them finite.
fn numbers(file: &SafeTensors<'_>, name: &str) -> Result<(Vec<usize>, Vec<f32>), String> {
    let tensor: TensorView<'_> = file.tensor(name).map_err(|_| {
        let all: BTreeSet<&str> = file.names().into_iter().collect();
        let all: Vec<&str> = all.into_iter().take(12).collect();
        let there = if all.is_empty() { "none".to_owned() } else { printable(&all.join(", ")) };
        format!("no tensor {name}; there are {there}")
    })?;
    if tensor.dtype() != Dtype::F32 {
        let kind = tensor.dtype();
        return Err(format!("{name} is of {kind:?}; save it as 32-bit floats (F32)"));
    }
    let (words, []) = tensor.data().as_chunks::<4>() else {
        return Err(format!("{name} ends in the middle of a number"));
    };
    let numbers: Vec<f32> = words.iter().map(|word| f32::from_le_bytes(*word)).collect();
    if let Some(at) = numbers.iter().position(|number| !number.is_finite()) {
        return Err(format!("{name}: number {at} is {}; was the training sound?", numbers[at]));
    }
    if numbers.is_empty() {
        return Err(format!("{name} is empty"));
    }
    Ok((tensor.shape().to_vec(), numbers))
}

#[cfg(test)]
mod tests {
    use super::super::made_up::{file, tensor};
    use super::*;

    const PLAIN: (Activation, Squash) = (Activation::Relu, Squash::None);

    fn read(bytes: &[u8], names: &[&str], widths: [usize; 2]) -> Result<Layers, String> {
        let names: Vec<String> = names.iter().map(|name| (*name).to_owned()).collect();
        Layers::read(bytes, &names, widths, PLAIN)
    }

    /// Two numbers in, three between, one out.
    fn bytes() -> Vec<u8> {
        file(&[
            tensor("a.weight", &[3, 2], &[1.0, 2.0, -1.0, 0.0, 0.5, 0.5]),
            tensor("a.bias", &[3], &[0.0, 1.0, -2.0]),
            tensor("b.weight", &[1, 3], &[1.0, 10.0, 100.0]),
            tensor("b.bias", &[1], &[-0.5]),
        ])
    }

    #[test]
    fn numbers_go_through_one_layer_after_the_other() {
        let mut layers = read(&bytes(), &["a", "b"], [2, 1]).unwrap();
        // (1 + 4, -1 + 1, 1.5 - 2), of which what is below zero does not pass.
        assert_eq!(layers.forward(&[1.0, 2.0]), [4.5]);
        assert_eq!(layers.forward(&[-3.0, 0.0]), [39.5]);
        layers.squash = Squash::Tanh;
        assert_eq!(layers.forward(&[1.0, 2.0]), [libm::tanhf(4.5)]);
    }

    #[test]
    fn activations_are_the_fields() {
        let of = |activation: Activation| [-2.0, 0.0, 3.0].map(|x| activation.of(x));
        let near = |a: [f32; 3], b: [f32; 3]| a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-6);
        assert!(near(of(Activation::Elu), [-0.864_664_7, 0.0, 3.0]));
        assert!(near(of(Activation::Relu), [0.0, 0.0, 3.0]));
        assert!(near(of(Activation::Silu), [-0.238_405_8, 0.0, 2.857_722_3]));
        for activation in [Activation::Elu, Activation::Relu, Activation::Silu, Activation::Tanh] {
            assert!(activation.of(f32::NAN).is_nan(), "{activation:?}");
        }
        assert!(near(of(Activation::Tanh), [-0.964_027_6, 0.0, 0.995_055]));
    }

    #[test]
    fn what_does_not_fit_is_refused_by_name() {
        let bytes = bytes();
        for (names, widths, says) in [
            (
                &["a", "b"][..],
                [3, 1],
                "a.weight takes 2 numbers, but what the [[input]] tables come to are 3",
            ),
            (&["a", "a"], [2, 3], "a.weight takes 2 numbers, but those that a gives are 3"),
            (&["a", "b"], [2, 8], "an action is 8 numbers, but those that b gives are 1"),
            (&["c"], [2, 1], "no tensor c.weight; there are a.bias, a.weight, b.bias, b.weight"),
        ] {
            let error = read(&bytes, names, widths).unwrap_err();
            assert!(error.contains(says), "{error}");
        }
        let sick = |weights: &[f32], shape: &[usize], bias: &[usize]| {
            let zeros = vec![0.0; bias.iter().product()];
            let bytes = file(&[tensor("a.weight", shape, weights), tensor("a.bias", bias, &zeros)]);
            read(&bytes, &["a"], [2, 1]).unwrap_err()
        };
        assert!(sick(&[f32::NAN, 0.0], &[1, 2], &[1]).contains("number 0 is NaN"));
        assert!(sick(&[0.0, 0.0], &[2], &[1]).contains("outputs by inputs"));
        assert!(sick(&[0.0, 0.0], &[1, 2], &[2]).contains("a.weight gives 1 numbers"));
        let odd = file(&[tensor("a\n\u{1b}[31m", &[1], &[0.0])]);
        let error = read(&odd, &["a"], [2, 1]).unwrap_err();
        assert!(error.lines().count() == 1 && !error.contains('\u{1b}'), "{error:?}");
        assert!(read(&bytes[..40], &["a"], [2, 1]).unwrap_err().contains("no safetensors"));
    }
}
