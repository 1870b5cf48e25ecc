//! A result kept with the inputs that it was computed from, so that it need not be computed again for equal
//! inputs.

/// Holds an output and the inputs that it was computed from; empty at first.
pub(crate) struct Cached<Inputs, Output> {
    entry: Option<(Inputs, Output)>,
}

impl<Inputs, Output> Default for Cached<Inputs, Output> {
    fn default() -> Self {
        Self { entry: None }
    }
}

impl<Inputs, Output> Cached<Inputs, Output> {
    pub(crate) fn inputs(&self) -> Option<&Inputs> {
        self.entry.as_ref().map(|(inputs, _)| inputs)
    }

    pub(crate) fn output(&self) -> Option<&Output> {
        self.entry.as_ref().map(|(_, output)| output)
    }

    pub(crate) fn clear(&mut self) {
        self.entry = None;
    }
}

impl<Inputs: PartialEq, Output> Cached<Inputs, Output> {
    /// The output for these inputs. If the cached inputs are equal, inputs and output stay as they are. If not,
    /// `compute` makes a new output from the new inputs and from what was cached before.
    pub(crate) fn update(
        &mut self,
        inputs: Inputs,
        compute: impl FnOnce(&Inputs, Option<(Inputs, Output)>) -> Output,
    ) -> &Output {
        match self.entry.take() {
            Some(entry) if entry.0 == inputs => &self.entry.insert(entry).1,
            before => {
                let output = compute(&inputs, before);
                &self.entry.insert((inputs, output)).1
            }
        }
    }

    /// As [`Cached::update`], for an output that must sometimes be resized although its inputs stay equal. So `compute`
    /// always runs; it gets the cached output if the cached inputs are equal.
    pub(crate) fn resize(
        &mut self,
        inputs: Inputs,
        compute: impl FnOnce(&Inputs, Option<Output>) -> Output,
    ) -> &Output {
        let before = self.entry.take().filter(|(before, _)| *before == inputs);
        let output = compute(&inputs, before.map(|(_, output)| output));
        &self.entry.insert((inputs, output)).1
    }
}

#[cfg(test)]
mod tests {
    use super::Cached;

    #[test]
    fn equal_inputs_are_computed_once_and_others_see_what_was_before() {
        let mut cached = Cached::default();
        assert_eq!(*cached.update("a", |_, before| (before.is_none(), 1)), (true, 1));
        assert_eq!(*cached.update("a", |_, _| unreachable!("the inputs are equal")), (true, 1));
        assert_eq!(*cached.update("b", |_, before| (before == Some(("a", (true, 1))), 2)), (true, 2));
        assert_eq!(cached.inputs(), Some(&"b"));
    }

    #[test]
    fn an_output_is_resized_while_its_inputs_are_equal() {
        let mut cached = Cached::default();
        let grown = |count: usize| {
            move |input: &u8, before: Option<Vec<u8>>| {
                let mut values = before.unwrap_or_default();
                values.resize(count, *input);
                values
            }
        };
        assert_eq!(*cached.resize(1, grown(2)), [1, 1]);
        assert_eq!(*cached.resize(1, grown(3)), [1, 1, 1]);
        assert_eq!(*cached.resize(2, grown(1)), [2]);
        cached.clear();
        assert_eq!(cached.output(), None);
    }
}
