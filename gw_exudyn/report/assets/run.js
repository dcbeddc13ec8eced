// The page of a run, or of a few: the player shows all of them.
setRuns(DATA.runs.map(unpacked));
listen(document);
refreshPlayer();
go(0);
