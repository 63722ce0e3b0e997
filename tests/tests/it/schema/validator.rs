//! JSON Schema, draft 7, as far as the schema of the text format uses it; any other keyword is refused.

use serde_json::{Map, Value};

/// Why an instance is not valid, with the path in it; none where it is.
pub(crate) fn refusal(schema: &Value, instance: &Value) -> Option<String> {
    Validator { root: schema }.check(schema, instance, "").err()
}

struct Validator<'s> {
    root: &'s Value,
}

type Outcome = Result<(), String>;

impl Validator<'_> {
    fn check(&self, schema: &Value, instance: &Value, path: &str) -> Outcome {
        let schema = schema.as_object().expect("a schema is an object");
        if let Some(reference) = schema.get("$ref") {
            assert_eq!(schema.len(), 1, "what stands beside $ref is ignored in draft 7");
            return self.check(self.referred(reference), instance, path);
        }
        schema.iter().try_for_each(|(keyword, value)| self.keyword(keyword, value, schema, instance, path))
    }

    fn referred(&self, reference: &Value) -> &Value {
        let pointer = reference.as_str().and_then(|text| text.strip_prefix('#')).expect("a local reference");
        self.root.pointer(pointer).unwrap_or_else(|| panic!("nothing is at {pointer}"))
    }

    fn keyword(
        &self,
        keyword: &str,
        value: &Value,
        schema: &Map<String, Value>,
        instance: &Value,
        path: &str,
    ) -> Outcome {
        let refuse = || Err(format!("{path}: {keyword} {value}"));
        let all = || value.as_array().expect("a list").iter();
        let bound = || value.as_f64().expect("a number");
        let length = instance.as_array().map(|list| list.len() as f64);
        let size = instance.as_object().map(|object| object.len() as f64);
        let holds = match keyword {
            "$schema" | "title" | "description" | "default" | "definitions" => true,
            "type" => match value {
                Value::Array(_) => all().any(|kind| is_of(instance, kind)),
                kind => is_of(instance, kind),
            },
            "enum" => all().any(|known| known == instance),
            "minimum" => instance.as_f64().is_none_or(|number| number >= bound()),
            "maximum" => instance.as_f64().is_none_or(|number| number <= bound()),
            "exclusiveMinimum" => instance.as_f64().is_none_or(|number| number > bound()),
            "exclusiveMaximum" => instance.as_f64().is_none_or(|number| number < bound()),
            "minItems" => length.is_none_or(|length| length >= bound()),
            "maxItems" => length.is_none_or(|length| length <= bound()),
            "minProperties" => size.is_none_or(|size| size >= bound()),
            "maxProperties" => size.is_none_or(|size| size <= bound()),
            "required" => {
                let has = |key: &Value| instance.get(key.as_str().expect("a key")).is_some();
                !instance.is_object() || all().all(has)
            }
            "anyOf" => all().any(|part| self.check(part, instance, path).is_ok()),
            "oneOf" => all().filter(|part| self.check(part, instance, path).is_ok()).count() == 1,
            "allOf" => return all().try_for_each(|part| self.check(part, instance, path)),
            "items" => {
                let elements = instance.as_array().into_iter().flatten().enumerate();
                return elements
                    .into_iter()
                    .try_for_each(|(i, element)| self.check(value, element, &format!("{path}/{i}")));
            }
            "properties" => {
                let entries = instance.as_object().into_iter().flatten();
                return entries.into_iter().try_for_each(|(key, entry)| match value.get(key) {
                    Some(part) => self.check(part, entry, &format!("{path}/{key}")),
                    None => Ok(()),
                });
            }
            "additionalProperties" => {
                let known =
                    |key: &String| schema.get("properties").is_some_and(|known| known.get(key).is_some());
                let mut others = instance.as_object().into_iter().flatten().filter(|(key, _)| !known(key));
                return match value {
                    Value::Bool(false) => {
                        others.next().map_or(Ok(()), |(key, _)| Err(format!("{path}: {key}")))
                    }
                    part => {
                        others.try_for_each(|(key, entry)| self.check(part, entry, &format!("{path}/{key}")))
                    }
                };
            }
            other => panic!("this validator does not know the keyword {other}"),
        };
        if holds { Ok(()) } else { refuse() }
    }
}

fn is_of(instance: &Value, kind: &Value) -> bool {
    match kind.as_str().expect("a type") {
        "string" => instance.is_string(),
        "number" => instance.is_number(),
        "integer" => instance.is_i64() || instance.is_u64(),
        "boolean" => instance.is_boolean(),
        "array" => instance.is_array(),
        "object" => instance.is_object(),
        other => panic!("this validator does not know the type {other}"),
    }
}
