//! Values of the scene file that remember their place, and those that may be written in two ways.

use std::fmt;
use std::ops::Range;

use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::de::{Deserialize, Deserializer, Error, IgnoredAny, MapAccess, SeqAccess, Visitor};

/// A value and its byte range in the file.
#[derive(Debug, Clone)]
pub struct At<T> {
    pub value: T,
    pub span: Range<usize>,
}

impl<'de, T: Deserialize<'de>> Deserialize<'de> for At<T> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let spanned = toml::Spanned::<T>::deserialize(deserializer)?;
        let span = spanned.span();
        Ok(At { value: spanned.into_inner(), span })
    }
}

/// The place is no part of the format.
impl<T: JsonSchema> JsonSchema for At<T> {
    fn inline_schema() -> bool {
        T::inline_schema()
    }
    fn schema_name() -> std::borrow::Cow<'static, str> {
        T::schema_name()
    }
    fn schema_id() -> std::borrow::Cow<'static, str> {
        T::schema_id()
    }
    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        T::json_schema(generator)
    }
}

/// An array of exactly `N` numbers (serde's own arrays let TOML ones be longer).
#[derive(Debug, Clone)]
pub struct Numbers<const N: usize>(pub [At<f64>; N]);

impl<'de, const N: usize> Deserialize<'de> for Numbers<N> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Elements<const N: usize>;
        impl<'de, const N: usize> Visitor<'de> for Elements<N> {
            type Value = Numbers<N>;
            fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
                write!(f, "an array of {N} numbers")
            }
            fn visit_seq<A: SeqAccess<'de>>(self, mut elements: A) -> Result<Self::Value, A::Error> {
                let mut numbers = Vec::with_capacity(N);
                while numbers.len() < N {
                    match elements.next_element::<At<f64>>()? {
                        Some(number) => numbers.push(number),
                        None => return Err(A::Error::invalid_length(numbers.len(), &self)),
                    }
                }
                let mut length = N;
                while elements.next_element::<IgnoredAny>()?.is_some() {
                    length += 1;
                }
                match <[At<f64>; N]>::try_from(numbers) {
                    Ok(numbers) if length == N => Ok(Numbers(numbers)),
                    _ => Err(A::Error::invalid_length(length, &self)),
                }
            }
        }
        deserializer.deserialize_any(Elements::<N>)
    }
}

impl<const N: usize> JsonSchema for Numbers<N> {
    fn inline_schema() -> bool {
        true
    }
    fn schema_name() -> std::borrow::Cow<'static, str> {
        format!("Numbers{N}").into()
    }
    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        json_schema!({ "type": "array", "items": { "type": "number" }, "minItems": N, "maxItems": N })
    }
}

/// A number, or an array whose elements are read as `T`.
#[derive(Debug, Clone)]
pub enum NumberOr<T> {
    Number(f64),
    Array(Vec<At<T>>),
}

impl<'de, T: Deserialize<'de>> Deserialize<'de> for NumberOr<T> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Either<T>(std::marker::PhantomData<T>);
        impl<'de, T: Deserialize<'de>> Visitor<'de> for Either<T> {
            type Value = NumberOr<T>;
            fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
                f.write_str("a number or an array")
            }
            fn visit_f64<E>(self, number: f64) -> Result<Self::Value, E> {
                Ok(NumberOr::Number(number))
            }
            fn visit_i64<E>(self, number: i64) -> Result<Self::Value, E> {
                Ok(NumberOr::Number(number as f64))
            }
            fn visit_seq<A: SeqAccess<'de>>(self, mut elements: A) -> Result<Self::Value, A::Error> {
                let mut array = Vec::new();
                while let Some(element) = elements.next_element()? {
                    array.push(element);
                }
                Ok(NumberOr::Array(array))
            }
        }
        deserializer.deserialize_any(Either(std::marker::PhantomData))
    }
}

impl<T: JsonSchema> JsonSchema for NumberOr<T> {
    fn inline_schema() -> bool {
        true
    }
    fn schema_name() -> std::borrow::Cow<'static, str> {
        format!("NumberOr{}", T::schema_name()).into()
    }
    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        let element = generator.subschema_for::<T>();
        json_schema!({ "anyOf": [{ "type": "number" }, { "type": "array", "items": element }] })
    }
}

/// One gas by its name, or mole fractions by name.
#[derive(Debug, Clone)]
pub enum RawMixture {
    Pure(String),
    Fractions(Vec<(At<String>, At<f64>)>),
}

impl<'de> Deserialize<'de> for RawMixture {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct NameOrTable;
        impl<'de> Visitor<'de> for NameOrTable {
            type Value = RawMixture;
            fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
                f.write_str("the name of a gas, or mole fractions such as { air = 0.8, helium = 0.2 }")
            }
            fn visit_str<E>(self, name: &str) -> Result<Self::Value, E> {
                Ok(RawMixture::Pure(name.to_string()))
            }
            fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<Self::Value, A::Error> {
                let mut fractions = Vec::new();
                while let Some(entry) = map.next_entry()? {
                    fractions.push(entry);
                }
                Ok(RawMixture::Fractions(fractions))
            }
        }
        deserializer.deserialize_any(NameOrTable)
    }
}

impl JsonSchema for RawMixture {
    fn inline_schema() -> bool {
        true
    }
    fn schema_name() -> std::borrow::Cow<'static, str> {
        "Mixture".into()
    }
    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        json_schema!({ "anyOf": [
            { "type": "string" },
            { "type": "object", "minProperties": 1, "additionalProperties": { "type": "number", "exclusiveMinimum": 0 } }
        ] })
    }
}
