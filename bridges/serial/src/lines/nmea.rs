//! Sentences of GPS receivers and ships: `$GPGLL,5057.970,N*hh`, with a checksum.

/// What is between `$` and `*`, if the checksum is right; without one it is taken as it is.
pub fn sentence(line: &str) -> Result<&str, String> {
    let inside = line.strip_prefix(['$', '!']).ok_or("it doesn't begin with `$`")?;
    let Some((text, sum)) = inside.rsplit_once('*') else { return Ok(inside) };
    let wanted = u8::from_str_radix(sum.trim(), 16).map_err(|_| "its checksum is none")?;
    let is = text.bytes().fold(0, |sum, byte| sum ^ byte);
    if is == wanted { Ok(text) } else { Err(format!("its checksum should be {is:02X}")) }
}
