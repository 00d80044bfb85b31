# Reads the tables of a study with pandas: see test_sampling.pl.
import pandas as pd
for read in (pd.read_csv, lambda f: pd.read_json(f, lines=True)):
    e = 'csv' if read is pd.read_csv else 'jsonl'
    runs = read('runs.' + e)
    assert len(runs) == 8, runs
    assert list(runs.columns) == ['seed', 'kind', 'n', 'late', 'm'], runs.columns
    assert runs.late.isna().sum() == 4
    means = runs.groupby(['kind', 'n']).m.mean()
    assert means['it"s, so', 2.5] == 3.75, means
    steps = read('steps.' + e)
    assert steps.groupby('time').s.max().to_dict() == {0: 1, 1: 3}
    summary = read('summary.' + e).set_index(['kind', 'n', 'measure'])
    row = summary.loc['new_one', 1, 'm']
    assert (row['mean'], row['median'], row.runs) == (1.5, 1.5, 2), row
    chosen = runs[(runs.kind == "new_one") & (runs.n == 1)]
    assert abs(row.sd - chosen.m.std()) < 1e-12
    claims = read('claims.' + e)
    assert bool(claims.of_medians[0]) is True
print('read')
