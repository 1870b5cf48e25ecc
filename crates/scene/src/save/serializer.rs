//! A serde serializer that turns a document into values, which `layout` then writes as RON. Its counterpart for loading
//! is `load::parse`.

use std::fmt::Error;

use serde::ser::{self, Impossible, Serialize, Serializer};

use super::layout::{Group, Value, number, text};

/// Turns a document into a [`Value`]. What no document holds (maps, bytes, units, structs of several unnamed fields) is
/// an error.
#[derive(Clone, Copy, Debug)]
pub(super) struct ToValue;

/// A group to be filled.
fn open(name: &'static str, brackets: [char; 2]) -> Result<Group, Error> {
    Ok(Group { name, brackets, items: Vec::new() })
}

impl Group {
    fn push(&mut self, field: &'static str, value: &(impl Serialize + ?Sized)) -> Result<(), Error> {
        self.items.push((field, value.serialize(ToValue)?));
        Ok(())
    }
}

/// Methods for values that are written as Rust displays them.
macro_rules! words {
    ($($method:ident: $type:ty),*) => {
        $(fn $method(self, value: $type) -> Result<Value, Error> {
            Ok(Value::Word(value.to_string()))
        })*
    };
}

impl Serializer for ToValue {
    type Ok = Value;
    type Error = Error;
    type SerializeSeq = Group;
    type SerializeTuple = Group;
    type SerializeTupleStruct = Impossible<Value, Error>;
    type SerializeTupleVariant = Group;
    type SerializeMap = Impossible<Value, Error>;
    type SerializeStruct = Group;
    type SerializeStructVariant = Group;

    words!(serialize_bool: bool, serialize_i8: i8, serialize_i16: i16, serialize_i32: i32, serialize_i64: i64);
    words!(serialize_u8: u8, serialize_u16: u16, serialize_u32: u32, serialize_u64: u64);

    fn serialize_f32(self, value: f32) -> Result<Value, Error> {
        Ok(number(f64::from(value)))
    }

    fn serialize_f64(self, value: f64) -> Result<Value, Error> {
        Ok(number(value))
    }

    fn serialize_char(self, value: char) -> Result<Value, Error> {
        Ok(text(value.encode_utf8(&mut [0; 4])))
    }

    fn serialize_str(self, value: &str) -> Result<Value, Error> {
        Ok(text(value))
    }

    fn serialize_bytes(self, _: &[u8]) -> Result<Value, Error> {
        Err(Error)
    }

    fn serialize_none(self) -> Result<Value, Error> {
        Ok(Value::Word("None".to_owned()))
    }

    /// Writes the value alone: scene files enable `implicit_some`.
    fn serialize_some<T: Serialize + ?Sized>(self, value: &T) -> Result<Value, Error> {
        value.serialize(self)
    }

    fn serialize_unit(self) -> Result<Value, Error> {
        Err(Error)
    }

    fn serialize_unit_struct(self, _: &'static str) -> Result<Value, Error> {
        Err(Error)
    }

    fn serialize_unit_variant(self, _: &'static str, _: u32, variant: &'static str) -> Result<Value, Error> {
        Ok(Value::Word(variant.to_owned()))
    }

    fn serialize_newtype_struct<T: Serialize + ?Sized>(
        self,
        _: &'static str,
        value: &T,
    ) -> Result<Value, Error> {
        value.serialize(self)
    }

    /// A variant that holds a struct is written with the struct's fields: `SumiE(rule: Painter)`.
    fn serialize_newtype_variant<T: Serialize + ?Sized>(
        self,
        _: &'static str,
        _: u32,
        variant: &'static str,
        value: &T,
    ) -> Result<Value, Error> {
        let value = value.serialize(self)?;
        let mut named = open(variant, ['(', ')'])?;
        match value {
            Value::Group(group) if group.items.iter().any(|(field, _)| !field.is_empty()) => {
                named.items = group.items;
            }
            value => named.items.push(("", value)),
        }
        Ok(Value::Group(named))
    }

    fn serialize_seq(self, _: Option<usize>) -> Result<Group, Error> {
        open("", ['[', ']'])
    }

    fn serialize_tuple(self, _: usize) -> Result<Group, Error> {
        open("", ['(', ')'])
    }

    fn serialize_tuple_struct(self, _: &'static str, _: usize) -> Result<Self::SerializeTupleStruct, Error> {
        Err(Error)
    }

    fn serialize_tuple_variant(
        self,
        _: &'static str,
        _: u32,
        variant: &'static str,
        _: usize,
    ) -> Result<Group, Error> {
        open(variant, ['(', ')'])
    }

    fn serialize_map(self, _: Option<usize>) -> Result<Self::SerializeMap, Error> {
        Err(Error)
    }

    fn serialize_struct(self, _: &'static str, _: usize) -> Result<Group, Error> {
        open("", ['(', ')'])
    }

    fn serialize_struct_variant(
        self,
        _: &'static str,
        _: u32,
        variant: &'static str,
        _: usize,
    ) -> Result<Group, Error> {
        open(variant, ['(', ')'])
    }
}

/// Implements one of serde's traits for a [`Group`] that is filled item by item. A struct's items have field names;
/// those of sequences and tuples have none.
macro_rules! filled {
    (@field) => {
        ""
    };
    (@field $field:ident) => {
        $field
    };
    ($group:ident, $method:ident $(, $field:ident)?) => {
        impl ser::$group for Group {
            type Ok = Value;
            type Error = Error;

            fn $method<T: Serialize + ?Sized>(
                &mut self,
                $($field: &'static str,)?
                value: &T,
            ) -> Result<(), Error> {
                self.push(filled!(@field $($field)?), value)
            }

            fn end(self) -> Result<Value, Error> {
                Ok(Value::Group(self))
            }
        }
    };
}

filled!(SerializeSeq, serialize_element);
filled!(SerializeTuple, serialize_element);
filled!(SerializeTupleVariant, serialize_field);
filled!(SerializeStruct, serialize_field, field);
filled!(SerializeStructVariant, serialize_field, field);
