:- module(typhon_prometheus,
          [ exposition/3                % +Metrics, //
          ]).

/** <module> Numbers in the text format of Prometheus

A metric is metric(Name, Type, Help, Samples), a sample
sample(Suffix, Labels, Value): Suffix is what follows the name of the metric,
as `_bucket`, Labels are Name=Value, Value anything, Value a number.

*Threading*: pure.
*/

%!  exposition(+Metrics:list, -Codes, ?Rest) is det.

exposition([]) --> [].
exposition([Metric|Metrics]) -->
    metric(Metric),
    exposition(Metrics).

metric(metric(_, _, _, [])) -->
    !.
metric(metric(Name, Type, Help, Samples)) -->
    "# HELP ", text(Name), " ", text(Help), "\n",
    "# TYPE ", text(Name), " ", text(Type), "\n",
    samples(Samples, Name).

samples([], _) --> [].
samples([sample(Suffix, Labels, Value)|Samples], Name) -->
    text(Name), text(Suffix), labels(Labels), " ", text(Value), "\n",
    samples(Samples, Name).

labels([]) -->
    !.
labels([Label|Labels]) -->
    "{", label(Label), more_labels(Labels), "}".

more_labels([]) --> [].
more_labels([Label|Labels]) -->
    ",", label(Label),
    more_labels(Labels).

label(Name=Value) -->
    { format(codes(Codes), '~w', [Value]) },
    text(Name), "=\"", escaped(Codes), "\"".

escaped([]) --> [].
escaped([Code|Codes]) -->
    escape(Code),
    escaped(Codes).

escape(0'\\) --> !, "\\\\".
escape(0'") --> !, "\\\"".
escape(0'\n) --> !, "\\n".
escape(Code) --> [Code].

text(Text, Codes, Rest) :-
    format(codes(Codes, Rest), '~w', [Text]).
