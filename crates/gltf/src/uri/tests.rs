use super::{Target, target};

fn file(name: &str) -> Result<Target, &'static str> {
    Ok(Target::File(name.to_owned()))
}

#[test]
fn names_are_decoded() {
    assert_eq!(target("a%20b/c.bin"), file("a b/c.bin"));
    assert_eq!(target("100%.bin"), file("100%.bin"));
    assert_eq!(target("a/../b.bin"), file("a/../b.bin"));
    assert_eq!(target("%E2%82%AC.png"), file("€.png"));
}

#[test]
fn names_that_lead_elsewhere_are_refused() {
    for uri in [
        "../a",
        "a/../../b",
        "%2e%2e/a",
        "%2Fetc/passwd",
        "/a",
        "//host/a",
        "file:///a",
        "C:/a",
        "C%3A/a",
        "http://a/b",
        "a%00b",
        "a\\b",
        "..%5Ca",
        "",
        "%FF",
        "a/./../../b",
    ] {
        assert!(target(uri).is_err(), "{uri:?}");
    }
}

#[test]
fn data_uris_are_decoded() {
    let data = |bytes: &[u8], media_type: &str| Ok(Target::Data(bytes.to_vec(), media_type.to_owned()));
    assert_eq!(
        target("data:application/octet-stream;base64,AQID"),
        data(&[1, 2, 3], "application/octet-stream")
    );
    assert_eq!(target("data:;base64,AQI="), data(&[1, 2], ""));
    assert_eq!(target("DATA:image/PNG;BASE64,AQ"), data(&[1], "image/png"));
    assert_eq!(target("data:,a%20b"), data(b"a b", ""));
    for uri in
        ["data:base64", "data:;base64,A", "data:;base64,AQ=A", "data:;base64,A?==", "data:;base64,AQ===="]
    {
        assert!(target(uri).is_err(), "{uri:?}");
    }
}
