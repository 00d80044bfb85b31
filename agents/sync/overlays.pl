% Overlays of synchronised agents on the page; facts overlay/4, see doc/page.md.

overlay('task executed', colour, log(executing(_, Task)), Task).
overlay('action potential', bar, log(psi(Psi)), Psi).
overlay('potential of learners', bar, log(reward(_, Potential, _)), Potential).
overlay('potential of learners', bar, log(penalty(_, Potential, _)), Potential).
