//! Orders out of JSON. By hand, since what serde derives for tagged enums would be a tenth of each bridge's library.

use serde_json::{Map, Value};

use crate::message::{Active, Call, Form, Item, Level, Order, Output, Variable};

/// What a line says; none: nothing that this version knows.
pub fn order(line: &str) -> Option<Order> {
    let mut line = Fields::of(serde_json::from_str(line).ok()?)?;
    Some(match line.text("order")?.as_str() {
        "describe" => Order::Describe { config: line.value("config") },
        "configure" => Order::Configure(line.form()?),
        "send" => Order::Send { items: line.values("items")?.into_iter().filter_map(item).collect() },
        "cancel" => Order::Cancel { id: line.id()? },
        "stop" => Order::Stop,
        "ping" => Order::Ping { id: line.id()? },
        "answer" => Order::Answer { id: line.id()?, error: line.optional_text("error")? },
        "variables" => Order::Variables { variables: line.list("variables", variable)? },
        "states" => Order::States { t: line.number("t")?, machines: line.list("machines", active)? },
        "log" => Order::Log {
            level: Level::named(&line.text("level")?)?,
            message: line.text("message")?,
            state: line.optional_text("state")?,
        },
        _ => return None,
    })
}

/// One that isn't known is left out; those beside it are not.
fn item(item: Value) -> Option<Item> {
    let mut fields = Fields::of(item)?;
    Some(match fields.text("call") {
        Some(call) => {
            Item::Call(Call { call, id: fields.id()?, arguments: fields.values("arguments").unwrap_or_default() })
        }
        None => Item::Output(Output { output: fields.text("output")?, value: fields.value("value") }),
    })
}

fn variable(mut fields: Fields) -> Option<Variable> {
    Some(Variable { path: fields.text("path")?, value: fields.value("value") })
}

fn active(mut fields: Fields) -> Option<Active> {
    Some(Active { machine: fields.text("machine")?, state: fields.text("state")?, since: fields.number("since")? })
}

/// An object's fields, each taken once.
struct Fields(Map<String, Value>);

impl Fields {
    fn of(value: Value) -> Option<Fields> {
        match value {
            Value::Object(fields) => Some(Fields(fields)),
            _ => None,
        }
    }

    fn value(&mut self, name: &str) -> Value {
        self.0.get_mut(name).map_or(Value::Null, Value::take)
    }

    fn text(&mut self, name: &str) -> Option<String> {
        match self.value(name) {
            Value::String(text) => Some(text),
            _ => None,
        }
    }

    /// None: it is something else than a text.
    fn optional_text(&mut self, name: &str) -> Option<Option<String>> {
        match self.value(name) {
            Value::Null => Some(None),
            Value::String(text) => Some(Some(text)),
            _ => None,
        }
    }

    fn number(&mut self, name: &str) -> Option<f64> {
        self.value(name).as_f64()
    }

    fn id(&mut self) -> Option<u64> {
        self.value("id").as_u64()
    }

    fn form(&mut self) -> Option<Form> {
        let folder = self.text("folder").unwrap_or_default().into();
        Some(Form { name: self.text("name")?, config: self.value("config"), folder })
    }

    fn list<T>(&mut self, name: &str, each: impl Fn(Fields) -> Option<T>) -> Option<Vec<T>> {
        self.values(name)?.into_iter().map(|item| each(Fields::of(item)?)).collect()
    }

    fn values(&mut self, name: &str) -> Option<Vec<Value>> {
        match self.value(name) {
            Value::Array(values) => Some(values),
            _ => None,
        }
    }
}
