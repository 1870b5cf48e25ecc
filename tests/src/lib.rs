//! Measuring tools that the tests share: reading pictures, comparing them, structure tensors.
