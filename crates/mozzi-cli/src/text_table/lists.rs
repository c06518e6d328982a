//! Cells that hold lists of numbers, as pandas, NumPy and Python write them: `[0.1, 0.2]`, `[0.1 0.2]`, `(0.1, 0.2)`,
//! `array('d', [0.1, 0.2])`. Each entry is a column `name[k]`.

/// The number of entries of each column that holds lists in the first row.
pub struct Lists(Vec<Option<usize>>);

impl Lists {
    /// From the cells of the first row.
    pub fn of(first: &[String]) -> Self {
        Lists(first.iter().map(|cell| Some(entries(cell)?.len())).collect())
    }

    pub fn are_there(&self) -> bool {
        self.0.iter().any(Option::is_some)
    }

    fn count(&self, column: usize) -> Option<usize> {
        self.0.get(column).copied().flatten()
    }

    /// The names of the columns of all entries.
    pub fn names(&self, names: &[String]) -> Vec<String> {
        let of = |(column, name): (usize, &String)| match self.count(column) {
            Some(count) => (0..count).map(|k| format!("{name}[{k}]")).collect(),
            None => vec![name.clone()],
        };
        names.iter().enumerate().flat_map(of).collect()
    }

    /// A text of each column, for each entry.
    pub fn repeated(&self, texts: &[String]) -> Vec<String> {
        let of = |(column, text): (usize, &String)| vec![text.clone(); self.count(column).unwrap_or(1)];
        texts.iter().enumerate().flat_map(of).collect()
    }

    /// The cells of a row, one for each entry; a list of another length stays whole, so that it is no number.
    pub fn cells<'c>(&self, cells: impl Iterator<Item = &'c str>) -> impl Iterator<Item = &'c str> {
        cells.enumerate().flat_map(|(column, cell)| match self.count(column) {
            Some(count) => entries(cell).filter(|found| found.len() == count).unwrap_or_else(|| vec![cell; count]),
            None => vec![cell],
        })
    }
}

/// The entries of a list of numbers.
fn entries(cell: &str) -> Option<Vec<&str>> {
    let cell = cell.trim().trim_matches('"').trim();
    if !(cell.starts_with(['[', '(']) || cell.starts_with("array(")) || !cell.ends_with([']', ')']) {
        return None;
    }
    let (begin, end) = match cell.find('[') {
        Some(begin) => (begin + 1, cell.rfind(']')?),
        None => (cell.find('(')? + 1, cell.rfind(')')?),
    };
    let inside = cell.get(begin..end)?.split([',', ' ', '\n', '\r', '\t']);
    let found: Vec<&str> = inside.filter(|text| !text.is_empty()).collect();
    found.iter().all(|text| text.parse::<f64>().is_ok()).then_some(found)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lists_are_split_as_python_writes_them() {
        for text in ["[0.1, -2]", "[ 0.1 -2. ]", "(0.1, -2)", "array('d', [0.1, -2])", "[0.1\n -2]", "\"[0.1,-2]\""] {
            let found: Option<Vec<f64>> =
                entries(text).map(|all| all.iter().map(|x| x.parse().expect("a number")).collect());
            assert_eq!(found, Some(vec![0.1, -2.0]), "{text}");
        }
        for text in ["0.1", "['a', 'b']", "[[1, 2]]", "q[0]", "(a)"] {
            assert_eq!(entries(text), None, "{text}");
        }
        let row = ["0".to_string(), "[1, 2]".to_string(), "()".to_string()];
        let lists = Lists::of(&row);
        assert_eq!(lists.names(&["t".into(), "q".into(), "effort".into()]), ["t", "q[0]", "q[1]"]);
        assert_eq!(lists.cells(["1", "[3 4]", "()"].into_iter()).collect::<Vec<_>>(), ["1", "3", "4"]);
        assert_eq!(lists.cells(["1", "[3]", "()"].into_iter()).collect::<Vec<_>>(), ["1", "[3]", "[3]"]);
    }
}
