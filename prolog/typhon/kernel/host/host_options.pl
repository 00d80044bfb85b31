:- module(typhon_host_options,
          [ host_listed/2               % +ListOrOne, -List
          ]).

/** <module> What may be said of a host that is started

What it means is described at host_start/2, which of it may be changed later at
host_change/2.

*Threading*: facts only.
*/

:- multifile typhon_options:declared/4.

typhon_options:declared(host_option, Option, Type, Value) :-
    host_option_type(Option, Type, Value).

host_option_type(port(X), between(0, 65535), X).
host_option_type(bind(X), atom, X).
host_option_type(capacity(X), nonneg, X).
host_option_type(capacity(X), oneof([inf]), X).
host_option_type(tokens(X), list, X).
host_option_type(concurrency(X), positive_integer, X).
host_option_type(concurrency(X), oneof([inf]), X).
host_option_type(consult(X), ground, X).
host_option_type(services(X), ground, X).
host_option_type(place(X), atom, X).
host_option_type(log(X), host_address, X).
host_option_type(log(X, _), host_address, X).
host_option_type(remote(X), boolean, X).
host_option_type(clock(X, Y), list(number), [X,Y]).
host_option_type(hop_time(uniform(X, Y)), list(number), [X,Y]).
host_option_type(seed(X), integer, X).
host_option_type(python(X), boolean, X).

%!  host_listed(+ListOrOne, -List) is det.
%
%   What is not a list is the only one in it.

host_listed(List, List) :-
    is_list(List),
    !.
host_listed(One, [One]).
