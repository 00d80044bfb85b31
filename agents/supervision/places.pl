% Expects: stood/2, and library(typhon)
% Gives: places/4

/*  Where a child is started: the places to try, the best one first.

      same            its previous host, first host(Host) of its options, or
                      the host of the supervisor
      here            the host of the supervisor
      least_loaded    the neighbour with the fewest agents
      tagged(Tag)     the neighbours, or here, with the fact tag(Tag) in their
                      tuple space
      on(Host)        Host

    or a list of these, which are tried in this order.
*/

places([], _, _, []) :-
    !.
places([Where|More], Name, Options, Places) :-
    !,
    places(Where, Name, Options, First),
    places(More, Name, Options, Rest),
    append(First, Rest, Places).
places(same, Name, Options, [Host]) :-
    (   stood(Name, Host)
    ->  true
    ;   option(host(Host), Options)
    ->  true
    ;   here(Host)
    ).
places(here, _, _, [Here]) :-
    here(Here).
places(on(Host), _, _, [Host]).
places(least_loaded, _, _, Hosts) :-
    neighbours(All),
    findall(Load-Host,
            ( member(Host, All),
              catch(host_property(Host, load(Load)), error(_, _), fail) ),
            Pairs0),
    keysort(Pairs0, Pairs),
    pairs_values(Pairs, Hosts).
places(tagged(Tag), _, _, Hosts) :-
    here(Here),
    neighbours(Neighbours),
    findall(Host,
            ( member(Host, [Here|Neighbours]),
              catch(remote(Host, sense(tag(Tag))), error(_, _), fail) ),
            Hosts).
